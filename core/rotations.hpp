// Rotations as unit quaternions w, x, y, z.
#pragma once
#include "dual.hpp"

namespace tactr {

/// v in the axes of the frame with quaternion q (q of unit length), from world axes.
template <class T, class V>
TACTR_ANY inline void to_frame(const T* q, const V v[3], T out[3]) {
    const T& w = q[0];
    const T tx = (q[2] * v[2] - q[3] * v[1]) * 2.0, ty = (q[3] * v[0] - q[1] * v[2]) * 2.0,
            tz = (q[1] * v[1] - q[2] * v[0]) * 2.0;
    out[0] = v[0] - w * tx + (q[2] * tz - q[3] * ty);
    out[1] = v[1] - w * ty + (q[3] * tx - q[1] * tz);
    out[2] = v[2] - w * tz + (q[1] * ty - q[2] * tx);
}

/// v in world axes, from the axes of the frame with quaternion q.
template <class T>
TACTR_ANY inline void to_world(const T* q, const T v[3], T* out) {
    const T& w = q[0];
    const T tx = (q[2] * v[2] - q[3] * v[1]) * 2.0, ty = (q[3] * v[0] - q[1] * v[2]) * 2.0,
            tz = (q[1] * v[1] - q[2] * v[0]) * 2.0;
    out[0] = v[0] + w * tx + (q[2] * tz - q[3] * ty);
    out[1] = v[1] + w * ty + (q[3] * tx - q[1] * tz);
    out[2] = v[2] + w * tz + (q[1] * ty - q[2] * tx);
}

template <class T>
TACTR_ANY inline void multiply_quaternions(const T* a, const T* b, T* out) {
    out[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    out[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
    out[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
    out[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

/// Quaternion of a rotation about z.
template <class T>
TACTR_ANY inline void turn_about_z(const T& angle, T* q) {
    sine_cosine(angle * 0.5, q[3], q[0]);
    q[1] = q[2] = T(0.0);
}

}  // namespace tactr
