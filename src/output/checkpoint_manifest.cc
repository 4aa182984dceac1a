#include "src/output/checkpoint_manifest.h"

#include "core/check.h"

#include <zlib.h>

namespace ligament::program
{
namespace
{
using Json = nlohmann::ordered_json; // keeps the file readable

constexpr int format = 2;

// The fields, once for both directions.
template <typename Manifest, typename Visit>
void for_each_field(Manifest &m, Visit &&visit)
{
  visit("number", m.number);
  visit("step", m.step);
  visit("time", m.time);
  visit("dt", m.dt);
  visit("started", m.started);
  visit("setup_seconds", m.setup_seconds);
  visit("wall_seconds", m.wall_seconds);
  visit("warnings", m.warnings);
  visit("version", m.version);
  visit("commit", m.commit);
  visit("instructions", m.instructions);
  visit("scene", m.scene);
  visit("positions", m.positions);
}

Json json_of(const core::StateFileSum &sum)
{
  return {{"bytes", sum.bytes}, {"checksum", sum.checksum}};
}

core::StateFileSum sum_of(const Json &json)
{
  return {json.at("bytes").get<std::int64_t>(), json.at("checksum").get<std::int64_t>()};
}

using Sums = std::map<std::string, core::StateFileSum>;

Json json_of(const Sums &sums)
{
  Json json = Json::object();
  for (const auto &[name, sum] : sums)
    json[name] = json_of(sum);
  return json;
}

Sums sums_of(const Json &json)
{
  Sums sums;
  for (const auto &[name, sum] : json.items())
    sums[name] = sum_of(sum);
  return sums;
}

std::string text_of(const Json &json)
{
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::int64_t checksum(const Json &json)
{
  const std::string text = text_of(json);
  return std::int64_t(crc32_z(0, reinterpret_cast<const Bytef *>(text.data()), text.size()));
}
} // namespace

std::string manifest_text(const CheckpointManifest &manifest)
{
  Json json;
  json["format"] = format;
  for_each_field(manifest, [&](const char *name, const auto &value) { json[name] = value; });
  Json &timing = json["timing"] = Json::array();
  for (const core::Timers::Row &row : manifest.timing)
    timing.push_back({{"name", row.name}, {"seconds", row.seconds}, {"calls", row.calls}});
  json["states"] = json_of(manifest.states);
  json["kept"] = json_of(manifest.kept);
  json["reference"] = manifest.reference ? json_of(*manifest.reference) : Json();
  json["checksum"] = checksum(json);
  return text_of(json);
}

CheckpointManifest parse_manifest(const std::string &text)
{
  CheckpointManifest manifest;
  try {
    Json json = Json::parse(text);
    // Written again it must be the same: no byte may differ, nor one that means nothing.
    core::require(text_of(json) == text, "damaged: not as it was written");
    const auto expected = json.at("checksum").get<std::int64_t>();
    json.erase("checksum");
    core::require(checksum(json) == expected, "damaged: its checksum is wrong");
    core::require(json.at("format").get<int>() == format,
                  "of another format than this program reads");
    for_each_field(manifest, [&](const char *name, auto &value) {
      value = json.at(name).get<std::decay_t<decltype(value)>>();
    });
    for (const Json &row : json.at("timing"))
      manifest.timing.push_back({row.at("name").get<std::string>(), row.at("seconds").get<double>(),
                                 row.at("calls").get<std::int64_t>()});
    manifest.states = sums_of(json.at("states"));
    manifest.kept = sums_of(json.at("kept"));
    if (const Json &reference = json.at("reference"); !reference.is_null())
      manifest.reference = sum_of(reference);
  } catch (const Json::exception &error) {
    throw core::InputError(std::string("damaged: ") + error.what());
  }
  return manifest;
}
} // namespace ligament::program
