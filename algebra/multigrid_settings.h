// What ML is asked for, whether one process has the levels or several share them.
#pragma once

#include <Eigen/Core>
#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>

namespace ligament::algebra
{
/// modes: of the rows that are here, one column each; ML keeps a pointer to them.
inline Teuchos::ParameterList multigrid_settings(int block_size, Eigen::MatrixXd &modes)
{
  Teuchos::ParameterList list;
  ML_Epetra::SetDefaults("SA", list);
  list.set("ML output", 0);
  list.set("PDE equations", block_size);
  list.set("aggregation: type", "Uncoupled");
  list.set("smoother: type", "Chebyshev");
  list.set("smoother: sweeps", 4);
  list.set("coarse: type", "Amesos-KLU");
  list.set("null space: type", "pre-computed");
  list.set("null space: dimension", int(modes.cols()));
  list.set("null space: vectors", modes.data());
  list.set("null space: add default vectors", false);
  return list;
}
} // namespace ligament::algebra
