// Whether the specimen still hangs together from one side to the other.
#pragma once

#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// True when no chain of bonds and cells joins the two sides across the axis.
template <int dim>
bool is_broken_across(const CoupledBody<dim> &body, int axis);
} // namespace ligament::program
