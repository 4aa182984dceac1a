// What measures something of a body: one class per kind behind this interface.
#pragma once

#include "src/output/run_folder.h"
#include "src/output/table.h"
#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// The body at one time, and what several gauges want of it but should be found once.
template <int dim>
class GaugeLook
{
public:
  GaugeLook(const CoupledBody<dim> &the_body, double the_time) : body(the_body), time(the_time) {}

  const CoupledBody<dim> &body;
  const double time; // s

  /// Of all particles in Pa, Voigt order.
  const Components<n_strains<dim>> &stresses()
  {
    if (stresses_[0].empty())
      body.force()->stresses(body.zone->state, stresses_);
    return stresses_;
  }

private:
  Components<n_strains<dim>> stresses_;
};

/// Reads columns of the history. What it keeps from look to look follows from the body alone, from
/// its present motion and the list of what broke: a gauge made anew reads the same bits, and no
/// state is saved.
template <int dim>
class Gauge
{
public:
  virtual ~Gauge() = default;

  /// Their names begin with that of the gauge.
  virtual std::vector<Column> columns() const = 0;
  /// Between forces and kick; one value for each column.
  virtual void read(GaugeLook<dim> &look, double *values) = 0;
  /// From what it reads, and how near to the truth that is; one line.
  virtual std::string description() const = 0;
  /// What it leaves behind besides its columns.
  virtual void write(const CoupledBody<dim> &, const RunFolder &) {}
};
} // namespace ligament::program
