// Dual numbers are carried through the march, ends of sections included, and the free end follows by the implicit
// function theorem: with r(x, a) = 0 at the base and outputs y(x, a), dy/da = y_a - y_x r_x^-1 r_a.
#include "sensitivity.hpp"

#include <cmath>
#include <vector>

#include "dense_output.hpp"
#include "free_end.hpp"
#include "march.hpp"

namespace tactr {

namespace {

/// Poses at stations, seen from the tip, of the innermost tube there.
template <class T>
class PoseReader {
  public:
    using SkipsEven = void;
    std::vector<T> position, quaternion;  // 3 and 4 for each station
    std::vector<char> found;

    PoseReader(const Layout<T>& layout, const std::vector<double>& stations)
        : position(3 * stations.size()), quaternion(4 * stations.size()), found(stations.size(), 0), layout_(layout),
          stations_(stations), next_(static_cast<int>(stations.size()) - 1) {}

    template <class M>
    void operator()(M& march, int k, const T* before, const T& s, const T& h) {
        const Section<T>& section = layout_.sections[k];
        if (section.guided || next_ < 0 || !(value(h) < -BREAKPOINT_GAP)) return;
        const double end = value(s) + value(h) - BREAKPOINT_GAP;
        if (stations_[next_] < end || !dense_.prepare(march, section, before, s, h)) return;
        for (; next_ >= 0 && stations_[next_] >= end; --next_) {
            T packed[STATES], own[4];
            dense_.at((stations_[next_] - s) / h, packed);
            for (int c = 0; c < 3; ++c) position[3 * next_ + c] = packed[march.packing.path + c];
            turn_about_z(packed[3 * (section.active_count - 1)], own);
            multiply_quaternions(packed + march.packing.frame, own, &quaternion[4 * next_]);
            found[next_] = 1;
        }
    }

  private:
    const Layout<T>& layout_;
    const std::vector<double>& stations_;
    int next_;
    DenseOutput<T, T> dense_;
};

class Sensitivity {
  public:
    Sensitivity(const RobotTables<double>& tables, const Solution& solution, const SensitivityRequest& request)
        : tables_(tables), robot_(tables.view()), solution_(solution), request_(request),
          plain_(cut_into_sections(robot_, solution.translation.data())), shooting_(robot_, plain_), n_(shooting_.unknowns),
          tendons_(robot_.tendon_count), tubes_(robot_.tube_count), actuators_(request.actuators ? tendons_ + tubes_ : 0),
          wrench_(request.probe >= 0.0 ? 6 : 0), inputs_(n_ + actuators_ + wrench_ + static_cast<int>(request.rates.size())),
          poses_(1 + static_cast<int>(request.stations.size())), rows_(6 * poses_ + (request.lengths ? tendons_ : 0)) {}

    bool find(Sensitivities& out) {
        residual_.assign(static_cast<size_t>(MAX_UNKNOWNS) * inputs_, 0.0);
        output_.assign(static_cast<size_t>(rows_) * inputs_, 0.0);
        for (int first = 0; first < inputs_ || first == 0;) {
            const bool few = inputs_ - first <= FEW;
            const bool found = request_.rates.empty() ? (few ? pass<FEW>(first) : pass<MANY>(first)) : pass_with_parameters(first);
            if (!found) return false;
            first += !request_.rates.empty() || !few ? MANY : FEW;
        }
        return withdraw_each() && gather(out);
    }

  private:
    static constexpr int FEW = 6, MANY = 14;

    const RobotTables<double>& tables_;
    const Robot robot_;
    const Solution& solution_;
    const SensitivityRequest& request_;
    const Layout<double> plain_;
    const Shooting shooting_;
    const int n_, tendons_, tubes_, actuators_, wrench_, inputs_, poses_, rows_;
    std::vector<double> residual_, output_;  // rows by inputs; inputs: unknowns, tensions, translations, wrench, parameters
    double tip_[3];
    std::vector<double> station_;
    int withdrawn_ = -1, only_ = -1;  // the tube of a pass that is for its translation alone, and that input

    /// Where proximal ends coincide and tendons run on other tubes, the hosts behind the guide depend on which tube is
    /// withdrawn: one pass for each.
    bool withdraw_each() {
        if (!actuators_ || !crosses_hosts()) return true;
        for (withdrawn_ = 0; withdrawn_ < tubes_; ++withdrawn_) {
            bool alone = true;
            for (int i = 0; i < tubes_; ++i)
                if (i != withdrawn_ && std::fabs(solution_.translation[i] - solution_.translation[withdrawn_]) <= BREAKPOINT_GAP) alone = false;
            only_ = n_ + tendons_ + withdrawn_;
            if (!alone && !(request_.rates.empty() ? pass<FEW>(only_) : pass_with_parameters(only_))) return false;
        }
        withdrawn_ = only_ = -1;
        return true;
    }

    bool crosses_hosts() const {
        for (int j = 0; j < tendons_; ++j)
            if (robot_.tendons[j].outermost) return true;
        return false;
    }

    template <int K>
    bool pass(int first) { return march_lanes<K>(robot_, first); }

    bool pass_with_parameters(int first) {
        std::vector<const RobotTables<double>*> rates(MANY, nullptr);
        for (int l = 0; l < MANY; ++l) {
            const int parameter = first + l - n_ - actuators_ - wrench_;
            if (parameter >= 0 && first + l < inputs_) rates[l] = request_.rates[parameter];
        }
        const RobotTables<Dual<MANY>> tables = moving<Dual<MANY>>(tables_, rates);
        return march_lanes<MANY>(tables.view(), first);
    }

    template <int K>
    static Dual<K> seeded(double v, int input, int first) {
        Dual<K> d(v);
        if (input >= first && input < first + K) d.d[input - first] = 1.0;
        return d;
    }

    template <int K, class C>
    bool march_lanes(const RobotOf<C>& robot, int first) {
        using D = Dual<K>;
        std::vector<D> tension, rotation, translation;
        const int none = inputs_ + K;
        for (int j = 0; j < tendons_; ++j) tension.push_back(seeded<K>(solution_.tension[j], actuators_ ? n_ + j : none, first));
        for (int i = 0; i < tubes_; ++i) {
            rotation.push_back(D(solution_.rotation[i]));
            const bool moves = actuators_ && (withdrawn_ < 0 || i == withdrawn_);
            translation.push_back(seeded<K>(solution_.translation[i], moves ? n_ + tendons_ + i : none, first));
        }
        const Actuation<D> actuation{tension.data(), rotation.data(), translation.data(), 1.0, 1.0};
        const bool inside = wrench_ && request_.probe < value(plain_.sections.back().distal) - BREAKPOINT_GAP;
        const D probe(request_.probe);
        const Layout<D> layout = cut_into_sections(robot, translation.data(), inside ? &probe : nullptr, withdrawn_);
        March<D, D, C> march(robot, layout, actuation, {true, true, true});
        shooting_.scale(march);
        if (wrench_) {
            march.probe_section = probe_section(layout, inside);
            march.probe_lane = n_ + actuators_ - first;
        }
        march.lengths_move = request_.lengths;
        FreeEnd<D> end;
        shooting_.seed(upright_end(), first, end);
        Mesh mesh = mesh_for(layout);
        PoseReader<D> reader(layout, request_.stations);
        if (!march.run(end, mesh, reader)) return false;
        for (char found : reader.found)
            if (!found) return false;
        keep(march, end, rotation, reader, first);
        return true;
    }

    /// The section at whose distal end the wrench acts.
    template <class P>
    int probe_section(const Layout<P>& layout, bool inside) const {
        int k = static_cast<int>(layout.sections.size()) - 1;
        if (inside)
            while (k > 0 && value(layout.sections[k].proximal) >= request_.probe - BREAKPOINT_GAP) --k;
        return k;
    }

    /// The free end with R_b as it is in world axes: a wrench in world axes has to know it.
    FreeEnd<double> upright_end() const {
        FreeEnd<double> end = solution_.free_end;
        if (shooting_.world) return end;
        double back[4];
        turn_about_z(-end.psi[shooting_.tip_tube], back);
        multiply_quaternions(solution_.tip_quaternion, back, end.quaternion);
        return end;
    }

    /// The solution's steps and strains; sections of no length and those that a probe cuts take the nearest strains.
    template <class P>
    Mesh mesh_for(const Layout<P>& layout) const {
        Mesh mesh = solution_.mesh;
        mesh.unknowns = 0;
        if (layout.sections.size() == plain_.sections.size()) return mesh;
        mesh.steps.clear();
        mesh.grade.clear();
        mesh.strains.clear();
        for (const Section<P>& section : layout.sections) {
            const double length = value(section.distal) - value(section.proximal);
            const int k = plain_section_at(value(section.proximal) + 0.5 * length);
            const int steps = length > BREAKPOINT_GAP ? solution_.mesh.steps[k] : 1;
            mesh.steps.push_back(steps);
            mesh.grade.push_back(steps == 1 ? 1.0 : solution_.mesh.grade_of(k));
            mesh.strains.insert(mesh.strains.end(), static_cast<size_t>(steps) * dp8::STAGES, strains_for(section, k));
        }
        mesh.warm = true;
        return mesh;
    }

    int plain_section_at(double s) const {
        size_t k = 0;
        while (k + 1 < plain_.sections.size() && plain_.sections[k].distal < s) ++k;
        return static_cast<int>(k);
    }

    /// Strains from the middle of a plain section, for the tubes that are in another one.
    template <class P>
    Strains strains_for(const Section<P>& section, int k) const {
        size_t first = 0;
        for (int j = 0; j < k; ++j) first += static_cast<size_t>(solution_.mesh.steps[j]) * dp8::STAGES;
        const Strains& from = solution_.mesh.strains[first + static_cast<size_t>(solution_.mesh.steps[k]) * dp8::STAGES / 2];
        Strains e{};
        if (!section.guided) {
            e.kx = from.kx;
            e.ky = from.ky;
            e.wx = from.wx;
            e.wy = from.wy;
        }
        for (int a = 0; a < section.active_count; ++a) {
            const int b = slot_of(plain_.sections[k], section.active[a]);
            e.tau[a] = b < 0 ? 0.0 : from.tau[b];
            e.eta[a] = b < 0 ? 0.0 : from.eta[b];
        }
        return e;
    }

    template <class M, class D>
    void keep(const M& march, const FreeEnd<D>& end, const std::vector<D>& rotation, const PoseReader<D>& reader, int first) {
        D r[MAX_UNKNOWNS], turn[4], p[3], q[4];
        shooting_.residual(march.base, rotation.data(), r);
        for (int i = 0; i < n_; ++i) keep_row(&residual_[static_cast<size_t>(i) * inputs_], r[i], first);
        shooting_.tip_pose(end, march.base, rotation[0], p, q);
        keep_pose(0, p, q, first);
        shooting_.world_turn(march.base, rotation[0], turn);
        station_.resize(3 * request_.stations.size());
        for (int k = 1; k < poses_; ++k) {
            D from_base[3];
            for (int c = 0; c < 3; ++c) from_base[c] = reader.position[3 * (k - 1) + c] - march.base.position[c];
            to_world(turn, from_base, p);
            multiply_quaternions(turn, &reader.quaternion[4 * (k - 1)], q);
            keep_pose(k, p, q, first);
            for (int c = 0; c < 3; ++c) station_[3 * (k - 1) + c] = p[c].v;
        }
        for (int c = 0; c < 3; ++c) tip_[c] = solution_.tip_position[c];
        if (!request_.lengths) return;
        for (int j = 0; j < tendons_; ++j)
            keep_row(&output_[static_cast<size_t>(6 * poses_ + j) * inputs_], march.moving_length[j], first);
    }

    template <class D>
    void keep_row(double* row, const D& x, int first) const {
        constexpr int K = LaneCount<D>::value;
        for (int l = 0; l < K && first + l < inputs_; ++l)
            if (only_ < 0 || first + l == only_) row[first + l] = x.d[l];
    }

    template <class D>
    void keep_pose(int pose, const D* p, const D* q, int first) {
        constexpr int K = LaneCount<D>::value;
        for (int c = 0; c < 3; ++c) keep_row(&output_[static_cast<size_t>(6 * pose + c) * inputs_], p[c], first);
        const double back[4] = {q[0].v, -q[1].v, -q[2].v, -q[3].v};
        for (int l = 0; l < K && first + l < inputs_; ++l) {
            if (only_ >= 0 && first + l != only_) continue;
            const double rate[4] = {q[0].d[l], q[1].d[l], q[2].d[l], q[3].d[l]};
            double turn[4];
            multiply_quaternions(rate, back, turn);
            for (int c = 0; c < 3; ++c) output_[static_cast<size_t>(6 * pose + 3 + c) * inputs_ + first + l] = 2.0 * turn[1 + c];
        }
    }

    bool gather(Sensitivities& out) const {
        const int rotations = request_.actuators ? tubes_ : 0;
        out.rows = rows_;
        out.columns = inputs_ - n_ + rotations;
        out.matrix.assign(static_cast<size_t>(out.rows) * out.columns, 0.0);
        double inverse[MAX_UNKNOWNS][MAX_UNKNOWNS], A[MAX_UNKNOWNS][MAX_UNKNOWNS];
        for (int i = 0; i < n_; ++i)
            for (int j = 0; j < n_; ++j) A[i][j] = residual_[static_cast<size_t>(i) * inputs_ + j];
        if (n_ > 0 && invert(n_, A, inverse) == 0.0) return false;
        for (int c = 0; c < out.columns; ++c) {
            const int rotation = c - (request_.actuators ? tendons_ : 0);
            const bool rotates = rotation >= 0 && rotation < rotations;
            const int input = n_ + (rotation >= rotations ? c - rotations : c);
            double r[MAX_UNKNOWNS];
            for (int i = 0; i < n_; ++i) r[i] = rotates ? rotated_residual(rotation, i) : residual_[static_cast<size_t>(i) * inputs_ + input];
            for (int row = 0; row < rows_; ++row) {
                const double* y = &output_[static_cast<size_t>(row) * inputs_];
                double sum = rotates ? rotated_output(rotation, row) : y[input];
                for (int j = 0; j < n_; ++j)
                    for (int i = 0; i < n_; ++i) sum -= y[j] * inverse[j][i] * r[i];
                out.matrix[static_cast<size_t>(row) * out.columns + c] = sum;
            }
        }
        return true;
    }

    /// Rotations enter the residual alone, and the first one turns everything about z besides.
    double rotated_residual(int tube, int i) const {
        if (shooting_.world) return i == 2 + tube ? -1.0 : 0.0;
        return tube == 0 ? 1.0 : i == tube - 1 ? -1.0 : 0.0;
    }

    double rotated_output(int tube, int row) const {
        if (tube > 0 || row >= 6 * poses_) return 0.0;
        const double* p = row < 6 ? tip_ : &station_[3 * (row / 6 - 1)];
        const double rates[6] = {-p[1], p[0], 0.0, 0.0, 0.0, 1.0};
        return rates[row % 6];
    }
};

}  // namespace

bool find_sensitivities(const RobotTables<double>& robot, const Solution& solution, const SensitivityRequest& request,
                        Sensitivities& out) {
    return Sensitivity(robot, solution, request).find(out);
}

}  // namespace tactr
