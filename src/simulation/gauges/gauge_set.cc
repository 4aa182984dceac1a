#include "src/simulation/gauges/gauge_set.h"

#include "core/keyed_error.h"
#include "src/simulation/gauges/crack_tip.h"
#include "src/simulation/gauges/field_gauges.h"
#include "src/simulation/gauges/force_gauge.h"
#include "src/simulation/gauges/fragments.h"
#include "src/simulation/gauges/j_integral.h"
#include "src/simulation/gauges/open_crack.h"
#include "src/simulation/gauges/point_gauges.h"
#include "src/simulation/gauges/tool_gauge.h"
#include "src/simulation/gauges/virial_stress.h"

#include <fmt/format.h>

namespace ligament::program
{
double default_smoothing(double duration)
{
  return 1. / 50 * duration;
}

namespace
{
template <int dim>
std::unique_ptr<Gauge<dim>> make_gauge(const GaugeParameters &gauge, const GaugePlaces<dim> &places)
{
  const double smoothing =
      gauge.smoothing > 0 ? gauge.smoothing : default_smoothing(places.scene.time.duration);
  switch (gauge.kind) {
  case GaugeKind::distance:
  case GaugeKind::opening:
    return std::make_unique<PointGauge<dim>>(gauge, places);
  case GaugeKind::strain:
    return std::make_unique<StrainGauge<dim>>(gauge, places);
  case GaugeKind::stress:
    return std::make_unique<StressGauge<dim>>(gauge, places);
  case GaugeKind::force:
    return std::make_unique<ForceGauge<dim>>(gauge, places.body);
  case GaugeKind::j_integral:
    return std::make_unique<JIntegral<dim>>(gauge, places);
  case GaugeKind::crack_tip:
    return std::make_unique<CrackTipGauge<dim>>(gauge, places.body, smoothing);
  case GaugeKind::virial_stress:
    return std::make_unique<VirialStressGauge<dim>>(gauge, places);
  case GaugeKind::open_crack:
    return std::make_unique<OpenCrackGauge<dim>>(gauge, places.body);
  default:
    return std::make_unique<FragmentGauge<dim>>(gauge, places.scene, places.body);
  }
}
} // namespace

template <int dim>
GaugeSet<dim>::GaugeSet(const Scene &scene, const CoupledBody<dim> &body)
{
  for (int k = 0; body.tools && k < body.tools->size(); ++k)
    add(body.tools->name(k), "tool", std::make_unique<ToolGauge<dim>>(k, body));
  if (scene.gauges.empty())
    return;
  const GaugePlaces<dim> places(scene, body);
  for (std::size_t k = 0; k < scene.gauges.size(); ++k) {
    const GaugeParameters &gauge = scene.gauges[k];
    add(gauge.name, words(gauge.kind)[std::size_t(gauge.kind)],
        core::at_key(fmt::format("/gauges/{}", k), "move it",
                     [&] { return make_gauge<dim>(gauge, places); }));
  }
}

template <int dim>
void GaugeSet<dim>::add(const std::string &name, const std::string &kind,
                        std::unique_ptr<Gauge<dim>> gauge)
{
  GaugeEntry entry{name, kind, {}, gauge->description()};
  for (const Column &column : gauge->columns()) {
    entry.columns.push_back(column.name);
    columns_.push_back(column);
  }
  entries_.push_back(std::move(entry));
  gauges_.push_back(std::move(gauge));
}

template <int dim>
std::vector<double> GaugeSet<dim>::read(const CoupledBody<dim> &body, double time)
{
  std::vector<double> values(columns_.size());
  GaugeLook<dim> look(body, time);
  double *next = values.data();
  for (std::size_t k = 0; k < gauges_.size(); ++k) {
    gauges_[k]->read(look, next);
    next += entries_[k].columns.size();
  }
  return values;
}

template <int dim>
void GaugeSet<dim>::watch(const Scene &scene, const CoupledBody<dim> &body)
{
  GaugeSet now(scene, body);
  now.entries_ = std::move(entries_);
  *this = std::move(now);
}

template <int dim>
void GaugeSet<dim>::write(const CoupledBody<dim> &body, const RunFolder &folder)
{
  for (const auto &gauge : gauges_)
    gauge->write(body, folder);
}

template class GaugeSet<2>;
template class GaugeSet<3>;
} // namespace ligament::program
