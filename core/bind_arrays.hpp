// Arrays of Python, in and out.
#pragma once
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tactr {

using Table = nanobind::ndarray<const double, nanobind::ndim<2>, nanobind::c_contig, nanobind::device::cpu>;
using Vector = nanobind::ndarray<const double, nanobind::ndim<1>, nanobind::c_contig, nanobind::device::cpu>;
using Shape = std::vector<size_t>;

inline std::vector<double> doubles_of(const Vector& v) { return {v.data(), v.data() + v.shape(0)}; }

inline std::vector<double> doubles_of(const Vector& v, size_t expected, const char* name) {
    if (v.shape(0) != expected) throw std::invalid_argument(std::string(name) + " has the wrong length");
    return doubles_of(v);
}

/// A numpy array that owns its numbers; first: where they are.
template <class T>
nanobind::object array_of(std::vector<T>&& data, const Shape& shape, T** first = nullptr) {
    auto* owned = new std::vector<T>(std::move(data));
    nanobind::capsule owner(owned, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    if (first) *first = owned->data();
    return nanobind::cast(nanobind::ndarray<nanobind::numpy, T>(owned->data(), shape.size(), shape.data(), owner));
}

}  // namespace tactr
