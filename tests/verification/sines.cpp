// Reads doubles; writes sine and cosine of each: as the march takes them, in a pack, in single precision, in a pack of that.
#include <cstdio>

#include "pack.hpp"

using namespace tactr;

template <class P>
void of_pack(double x, double* out) {
    P s, c;
    sine_cosine(P(x), s, c);
    double values[2 * P::COUNT];
    store(s, values);
    store(c, values + P::COUNT);
    out[0] = values[P::COUNT - 1];
    out[1] = values[P::COUNT];
}

int main() {
    for (double x; std::fread(&x, sizeof x, 1, stdin) == 1;) {
        double out[8];
        sine_cosine(x, out[0], out[1]);
        of_pack<Pack>(x, out + 2);
        RoughReal s, c;
        sine_cosine(RoughReal(x), s, c);
        out[4] = s.v;
        out[5] = c.v;
        of_pack<RoughPack>(x, out + 6);
        std::fwrite(out, sizeof out, 1, stdout);
    }
}
