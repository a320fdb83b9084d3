// A robot that owns its arrays, and the same robot with derivatives along directions in its own constants.
#pragma once
#include <cstddef>
#include <vector>

#include "robot.hpp"

namespace tactr {

/// C: double, or a dual number. view() hands the arrays to the kernel.
template <class C>
struct RobotTables {
    std::vector<TubeOf<C>> tubes;
    std::vector<TubePieceOf<C>> pieces;
    std::vector<TendonOf<C>> tendons;
    std::vector<RoutingPieceOf<C>> routing;
    std::vector<TensionPieceOf<C>> profiles;
    std::vector<PointLoadOf<C>> point_loads;
    std::vector<DistributedLoadOf<C>> distributed_loads;

    RobotOf<C> view() const {
        return {static_cast<int>(tubes.size()),       static_cast<int>(tendons.size()),
                static_cast<int>(point_loads.size()), static_cast<int>(distributed_loads.size()),
                tubes.data(),   pieces.data(),   tendons.data(),           routing.data(),
                profiles.data(), point_loads.data(), distributed_loads.data()};
    }
};

// Visits the numbers of two equal robots side by side: f(of a, of b).

template <class A, class B, class F> void pair_up(TubeOf<A>& a, const TubeOf<B>& b, F f) {
    f(a.length, b.length);
    f(a.rotation_compliance, b.rotation_compliance);
}
template <class A, class B, class F> void pair_up(TendonOf<A>& a, const TendonOf<B>& b, F f) { f(a.end, b.end); }

template <class A, class B, class F> void pair_up(TubePieceOf<A>& a, const TubePieceOf<B>& b, F f) {
    f(a.start, b.start);
    for (int k = 0; k < a.count; ++k)
        for (int q = 0; q < QUANTITIES; ++q) f(a.c[k][q], b.c[k][q]);
}

template <class A, class B, class F> void pair_up(RoutingPieceOf<A>& a, const RoutingPieceOf<B>& b, F f) {
    f(a.start, b.start);
    f(a.end, b.end);
    for (int k = 0; k < a.count_a; ++k) f(a.a[k], b.a[k]);
    for (int k = 0; k < a.count_b; ++k) f(a.b[k], b.b[k]);
}

template <class A, class B, class F> void pair_up(TensionPieceOf<A>& a, const TensionPieceOf<B>& b, F f) {
    f(a.start, b.start);
    for (int k = 0; k < a.count; ++k) f(a.c[k], b.c[k]);
}

template <class A, class B, class F> void pair_up(PointLoadOf<A>& a, const PointLoadOf<B>& b, F f) {
    f(a.at, b.at);
    for (int c = 0; c < 3; ++c) {
        f(a.force[c], b.force[c]);
        f(a.moment[c], b.moment[c]);
    }
}

template <class A, class B, class F> void pair_up(DistributedLoadOf<A>& a, const DistributedLoadOf<B>& b, F f) {
    f(a.start, b.start);
    f(a.end, b.end);
    for (int c = 0; c < 3; ++c) {
        f(a.force[c], b.force[c]);
        f(a.moment[c], b.moment[c]);
    }
}

// What is no number of the robot's own.

template <class C> TubeOf<C> blank(const Tube& t) { return {C(0.0), C(0.0), t.weight_per_gravity, t.piece_begin, t.piece_end}; }
template <class C> TubePieceOf<C> blank(const TubePiece& p) { return {C(0.0), p.count, p.plain, {}}; }
template <class C> RoutingPieceOf<C> blank(const RoutingPiece& p) { return {C(0.0), C(0.0), p.polar, p.count_a, p.count_b, {}, {}}; }
template <class C> TensionPieceOf<C> blank(const TensionPiece& p) { return {C(0.0), p.count, {}}; }
template <class C> TendonOf<C> blank(const Tendon& t) {
    return {t.tube, t.outermost, C(0.0), t.piece_begin, t.piece_end, t.profile_begin, t.profile_end};
}
template <class C> PointLoadOf<C> blank(const PointLoad& l) { return {l.tube, l.body_axes, C(0.0), {}, {}}; }
template <class C> DistributedLoadOf<C> blank(const DistributedLoad& l) { return {l.tube, l.body_axes, C(0.0), C(0.0), {}, {}}; }

/// One table with lane l moving along rates[l].*table.
template <class D, template <class> class Row>
void lift(const RobotTables<double>& base, const std::vector<const RobotTables<double>*>& rates,
          std::vector<Row<double>> RobotTables<double>::*table, std::vector<Row<D>>& out) {
    for (std::size_t i = 0; i < (base.*table).size(); ++i) {
        out.push_back(blank<D>((base.*table)[i]));
        pair_up(out.back(), (base.*table)[i], [](D& to, double from) { to = D(from); });
        for (std::size_t l = 0; l < rates.size(); ++l)
            if (rates[l] && i < (rates[l]->*table).size()) pair_up(out.back(), (rates[l]->*table)[i], [l](D& to, double rate) { to.d[l] = rate; });
    }
}

/// The robot whose lane l moves at rates[l], where there is one.
template <class D>
RobotTables<D> moving(const RobotTables<double>& base, const std::vector<const RobotTables<double>*>& rates) {
    RobotTables<D> out;
    lift<D, TubeOf>(base, rates, &RobotTables<double>::tubes, out.tubes);
    lift<D, TubePieceOf>(base, rates, &RobotTables<double>::pieces, out.pieces);
    for (std::size_t i = 0; i < out.pieces.size(); ++i)  // a tube may be about to be plain no more
        for (const RobotTables<double>* rate : rates)
            if (rate && !rate->pieces[i].plain) out.pieces[i].plain = 0;
    lift<D, TendonOf>(base, rates, &RobotTables<double>::tendons, out.tendons);
    lift<D, RoutingPieceOf>(base, rates, &RobotTables<double>::routing, out.routing);
    lift<D, TensionPieceOf>(base, rates, &RobotTables<double>::profiles, out.profiles);
    lift<D, PointLoadOf>(base, rates, &RobotTables<double>::point_loads, out.point_loads);
    lift<D, DistributedLoadOf>(base, rates, &RobotTables<double>::distributed_loads, out.distributed_loads);
    return out;
}

/// Whether robot b can be the rates of robot a: as many of everything, but that a may have more point loads, at the end,
/// of which nothing changes.
inline bool same_layout(const RobotTables<double>& a, const RobotTables<double>& b) {
    return a.tubes.size() == b.tubes.size() && a.pieces.size() == b.pieces.size() && a.tendons.size() == b.tendons.size() &&
           a.routing.size() == b.routing.size() && a.profiles.size() == b.profiles.size() &&
           a.point_loads.size() >= b.point_loads.size() && a.distributed_loads.size() == b.distributed_loads.size();
}

}  // namespace tactr
