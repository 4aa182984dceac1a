// Supernodal Cholesky factor of a block matrix.
#pragma once

#include "algebra/preconditioner.h"

namespace ligament::algebra
{
/// By which method unknowns are ordered before they are eliminated.
enum class Ordering
{
  minimum_degree,   // AMD
  nested_dissection // METIS
};

std::unique_ptr<Preconditioner> make_cholesky(const BlockMatrix &matrix, Ordering ordering);
} // namespace ligament::algebra
