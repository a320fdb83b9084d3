#pragma once
#include <nanobind/nanobind.h>

namespace tactr {

void bind_batch(nanobind::module_& m);

}  // namespace tactr
