// krepl buffer --owner nearest: zones of features or groups that do not overlap.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "feature_zones.hpp"
#include "input/collected.hpp"
#include "krepl/voronoi.hpp"
#include "output/feature_file.hpp"
#include "output/owner_geometry.hpp"
#include "output/zone_writers.hpp"
#include "stopwatch.hpp"

namespace krepl::app {

namespace {

/// All features as one network. Rings count by feature, whatever numbers the file gives its features.
Result<VoronoiDiagram> diagram_of(const GroupJob& job, std::vector<std::uint32_t>& part_owner, Session& session) {
  std::vector<std::uint32_t> owner(job.data.size());
  for (std::size_t g = 0; g < job.groups.size(); ++g) {
    for (const std::size_t f : job.groups[g].features) owner[f] = std::uint32_t(g);
  }
  Network::Builder builder;
  for (std::size_t f = 0; f < job.data.size(); ++f) {
    for (std::size_t i = job.data.part_begin[f]; i < job.data.part_begin[f + 1]; ++i) {
      input::add_part(builder, job.data.parts, i, std::int64_t(f));
      part_owner.push_back(owner[f]);
    }
  }
  Result<Network> network = std::move(builder).build(session.context("reading"));
  if (!network) return network.error();
  return VoronoiDiagram::build(std::make_shared<const Network>(std::move(*network)), session.context("diagram"));
}

output::ZoneRow row_of(const OwnerZone& zone, double radius, const output::ZoneFileOptions& file,
                       const output::GeometryStyle& style) {
  output::ZoneRow row;
  output::Linearizer linearizer(radius, output::max_error_for(file, radius));
  row.geometry =
      style.curves ? output::owner_curve_geometry(zone) : output::owner_linear_geometry(zone, linearizer, style.sense);
  row.deviation = std::max(linearizer.deviation(), zone.deviation);
  return row;
}

/// The shares at all radii.
using Shares = std::vector<std::vector<OwnerZone>>;

Result<Shares> compute_shares(const GroupJob& job, Session& session) {
  std::vector<std::uint32_t> part_owner;
  Result<VoronoiDiagram> diagram = diagram_of(job, part_owner, session);
  if (!diagram) return diagram.error();
  Shares shares;
  for (const double radius : job.radii) {
    auto found = diagram->owner_zones(radius, part_owner, output::max_error_for(job.job.file, radius),
                                      session.context("computing"));
    if (!found) return found.error();
    shares.push_back(std::move(*found));
  }
  return shares;
}

}  // namespace

int write_owners(const GroupJob& job, Session& session) {
  Stopwatch total;
  const std::string in_name = input_name(job.job.input.path), out_name = output_name(job.job.output);
  const Result<Shares> shares = compute_shares(job, session);
  if (!shares) return session.fail(in_name, shares.error());
  const bool counts = !job.job.features.dissolve_by.empty();
  std::vector<std::size_t> at(job.radii.size(), 0);  // per radius: the next share, which are sorted by owner
  std::size_t k = 0, written = 0;
  double area = 0;
  const Context writing = session.context("writing");
  const auto next = [&](const output::GeometryStyle& style) -> Result<std::optional<output::ZoneRow>> {
    for (; k < job.groups.size() * job.radii.size(); ++k) {
      if (writing.cancelled()) return output::interrupted_while_writing();
      const std::size_t group = k / job.radii.size(), r = k % job.radii.size();
      const auto& found = (*shares)[r];
      if (at[r] == found.size() || found[at[r]].owner != group) continue;
      const OwnerZone& zone = found[at[r]++];
      output::ZoneRow row = row_of(zone, job.radii[r], job.job.file, style);
      row.attributes = job.groups[group].row;
      if (counts) row.values.push_back(double(job.groups[group].features.size()));
      row.values.insert(row.values.end(), {job.radii[r], zone.area, zone.perimeter});
      area += zone.area;
      ++k, ++written;
      return std::optional<output::ZoneRow>(std::move(row));
    }
    return std::optional<output::ZoneRow>{};
  };
  auto report = output::write_features(job.job.output, job.job.format, job.job.file.crs, columns_of(job), next);
  if (!report) return session.fail(out_name, report.error());
  if (const std::size_t none = job.groups.size() * job.radii.size() - written; none > 0) {
    report->notes.push_back(fmt::format("note: {} zones are left out, for another feature is as near to all of their places",
                                        none));
  }
  tell(*report, job.job, session);
  session.summary(fmt::format("{} features; {} zones without overlap, areas {:.10g} in all; {:.3f} s", job.data.size(),
                              written, area, total.seconds()),
                  job.job.output == "-");
  return 0;
}

}  // namespace krepl::app
