// What the march carries, and what surrounds it: free end, base, mesh.
#pragma once
#include <cmath>
#include <type_traits>
#include <vector>

#include "dp8_tableau.hpp"
#include "dual.hpp"
#include "robot.hpp"
#include "section_equilibrium.hpp"

namespace tactr {

// Where each state stands in the state vector.
constexpr int PSI = 0;                 // angle of tube i's material frame from R_b
constexpr int N3 = MAX_TUBES;          // axial resultant of tube i
constexpr int M3 = 2 * MAX_TUBES;      // torsional resultant of tube i
constexpr int SUM_N = 3 * MAX_TUBES;   // (S_x, S_y): transverse resultant of all tubes, in R_b
constexpr int SUM_M = SUM_N + 2;       // (Q_x, Q_y)
constexpr int QUAT = SUM_M + 2;        // R_b as a quaternion w, x, y, z
constexpr int POS = QUAT + 4;          // p
constexpr int STATES = POS + 3;

constexpr int MAX_UNKNOWNS = MAX_TUBES + 2;
constexpr int STRAINS = 4 + 2 * MAX_TUBES;  // of one section, at most

template <class T>
using LaneCount = std::conditional_t<std::is_same_v<T, double>, std::integral_constant<int, 0>,
                                     std::integral_constant<int, (sizeof(T) / sizeof(double)) - 1>>;

/// Which states the march carries beside the tubes' own.
struct MarchOptions {
    bool sums;   // transverse resultants summed over the tubes: zero for one tube without external loads
    bool frame;  // R_b: for loads in world axes, and for the path
    bool path;   // p, and the lengths of the tendons
};

/// Free-end unknowns: angle of every tube at its distal end, and R_b at the tip.
template <class T>
struct FreeEnd {
    T psi[MAX_TUBES];
    T quaternion[4];
};

/// What the march finds at the base.
template <class T>
struct BaseState {
    T psi[MAX_TUBES];  // at each tube's own proximal end
    T quaternion[4];   // R_b at the guide exit
    T position[3];     // p at the guide exit (p = 0 at the tip)
};

/// Steps per section, and the strains found at every stage with their slopes in the unknowns: the next march starts
/// its sections from strains + slopes * shift.
struct Mesh {
    std::vector<int> steps;
    std::vector<double> grade;   // per section, length of a step over that of the one before, from the tip on; empty: 1
    std::vector<double> edges;   // s of the sections' ends in a solution, from the base on; empty: not known
    std::vector<double> excess;  // per section, its error over what it may be at the most; empty: not known
    std::vector<Strains> strains;
    std::vector<double> slopes;  // stage-major, unknowns innermost
    int unknowns = 0;            // 0: no slopes
    FreeEnd<double> marched{};   // of the last march that filled it
    double shift[MAX_UNKNOWNS] = {};
    bool warm = false;

    void cut(size_t sections, int steps_each) {
        steps.assign(sections, steps_each);
        grade.assign(sections, 1.0);
    }

    double grade_of(size_t section) const { return section < grade.size() ? grade[section] : 1.0; }

    /// Share of the section that lies beyond step i of n, from its distal end.
    static double share_before(int i, int n, double grade) {
        if (std::fabs(grade - 1.0) < 1e-9) return static_cast<double>(i) / n;
        return (1.0 - std::pow(grade, i)) / (1.0 - std::pow(grade, n));
    }

    /// The grade of n steps by which all of an eighth-order rule would err alike, from the errors of the first and the
    /// last of the steps as they are.
    double even_grade(size_t section, int n, double first_error, double last_error) const {
        constexpr double MOST = 4.0;  // between the longest step and the shortest
        const int now = steps[section];
        if (now < 2 || n < 2 || !(first_error > 0.0) || !(last_error > 0.0)) return grade_of(section);
        const double span = std::pow(grade_of(section), now - 1) * std::pow(first_error / last_error, 1.0 / 9.0);
        return std::pow(larger(1.0 / MOST, smaller(MOST, span)), 1.0 / (n - 1));
    }

    /// Steps between two places by what sections there had: as long as the longest of their steps, or longer where an
    /// eighth-order rule may still err less than it may. 1 where there were none.
    int steps_needed(double from, double to) const {
        constexpr double SPECK = 1e-9;  // m
        const bool known = excess.size() == steps.size();
        double longest = 0.0, rate = 0.0;
        for (size_t k = 0; k < steps.size(); ++k) {
            const double shared = smaller(edges[k + 1], to) - larger(edges[k], from), length = edges[k + 1] - edges[k];
            if (!(shared > SPECK)) continue;
            longest = larger(longest, length / steps[k]);
            if (known) rate += excess[k] * shared / length * std::pow(steps[k] * (to - from) / length, 8.0);
        }
        const double by_length = longest > 0.0 ? std::round((to - from) / longest) : 1.0;
        return static_cast<int>(!known ? by_length : smaller(by_length, std::ceil(std::pow(rate, 0.125))));
    }

    int total() const {
        int sum = 0;
        for (int n : steps) sum += n;
        return sum;
    }
    void fit() {
        strains.resize(static_cast<size_t>(total()) * dp8::STAGES);
        unknowns = 0;
        warm = false;
    }
};

/// The states that change in one section, side by side: psi, N_3, M_3 of every tube present, then the shared ones.
struct Packing {
    int index[STATES];  // place in the full state vector
    int count = 0, fed_back = 0;           // all; those on which rates depend: all but p, which stands last
    int sums = -1, frame = -1, path = -1;  // where the shared states start; -1: absent

    TACTR_ANY void set(const int* active, int active_count, bool guided, const MarchOptions& options) {
        count = 0;
        for (int a = 0; a < active_count; ++a) {
            index[count++] = PSI + active[a];
            index[count++] = N3 + active[a];
            index[count++] = M3 + active[a];
        }
        sums = frame = path = -1;
        if (options.sums && !guided) sums = append(SUM_N, 4);
        if (options.frame) frame = append(QUAT, 4);
        fed_back = count;
        if (options.path && !guided) path = append(POS, 3);
    }

  private:
    TACTR_ANY int append(int first, int number) {
        const int place = count;
        for (int c = 0; c < number; ++c) index[count++] = first + c;
        return place;
    }
};

}  // namespace tactr
