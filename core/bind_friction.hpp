#pragma once
#include <nanobind/nanobind.h>

namespace tactr {

void bind_friction(nanobind::module_& m);

}  // namespace tactr
