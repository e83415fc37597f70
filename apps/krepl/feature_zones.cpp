#include "feature_zones.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "kernel/parallel.hpp"
#include "krepl/curve_zone.hpp"
#include "krepl/zone.hpp"
#include "output/feature_file.hpp"
#include "output/ogr_geometry.hpp"
#include "output/zone_writers.hpp"
#include "shape_options.hpp"
#include "stopwatch.hpp"

namespace krepl::app {

namespace {

/// Zones of groups, computed a block ahead of the file they go to: small groups side by side, large ones one after the
/// other on all threads. The cut into blocks does not depend on the number of threads.
class GroupZones {
 public:
  GroupZones(const GroupJob& job, const Context& context)
      : job_(job), context_(context), per_group_(job.radii.empty() ? 1 : job.radii.size()), total_(job.groups.size() * per_group_) {}

  /// Zone number k: of group k / radii, at radius k % radii.
  Result<const Zone*> zone(std::size_t k) {
    if (k >= end_) {
      if (Status computed = compute_block(); !computed) return computed.error();
    }
    if (context_.progress) context_.progress(double(k) / double(total_));
    return &zones_[k - begin_];
  }
  std::size_t total() const { return total_; }
  const FeatureGroup& group(std::size_t k) const { return job_.groups[k / per_group_]; }

 private:
  static constexpr std::size_t block = 512, large = 1 << 16;

  std::size_t vertex_count(std::size_t k) const {
    std::size_t count = 0;
    for (const std::size_t f : group(k).features) {
      const auto& parts = job_.data.parts;
      count += parts.begin[job_.data.part_begin[f + 1]] - parts.begin[job_.data.part_begin[f]];
    }
    return count;
  }

  bool has_arcs(std::size_t k) const {
    const auto& parts = job_.data.parts;
    return std::ranges::any_of(group(k).features, [&](std::size_t f) {
      const std::size_t first = parts.begin[job_.data.part_begin[f]], last = parts.begin[job_.data.part_begin[f + 1]];
      const auto middle = std::lower_bound(parts.middle.begin(), parts.middle.end(), first);
      return middle != parts.middle.end() && *middle < last;
    });
  }

  template <class AnyNetwork>
  Result<Zone> compute(std::size_t k, const Context& context) const {
    typename AnyNetwork::Builder builder;
    std::vector<double> part_radii;
    add_features(job_.data, group(k).features, builder, part_radii);
    Result<AnyNetwork> network = std::move(builder).build(context);
    if (!network) return network.error();
    auto shared = std::make_shared<const AnyNetwork>(std::move(*network));
    const bool own = job_.radii.empty();  // then, of all parts of the one feature, the same
    ShapeOptions shape = job_.job.shape;
    if (!own || !part_radii.empty()) shape.distance = own ? part_radii.front() : job_.radii[k % per_group_];
    if (!is_plain(shape, {shape.distance})) return compute_shape(std::move(shared), shape, context);
    if (own) return compute_zone(std::move(shared), part_radii, context);
    return compute_zone(std::move(shared), ZoneOptions{shape.distance}, context);
  }
  Result<Zone> compute(std::size_t k, const Context& context) const {
    return has_arcs(k) ? compute<CurveNetwork>(k, context) : compute<Network>(k, context);
  }

  Status compute_block() {
    begin_ = end_;
    end_ = std::min(total_, begin_ + block);
    std::vector<std::optional<Result<Zone>>> found(end_ - begin_);
    Context alone;
    alone.threads = 1;
    alone.cancel = context_.cancel;
    Context side_by_side;
    side_by_side.threads = context_.threads, side_by_side.cancel = context_.cancel;
    const bool done = kernel::parallel_blocks(side_by_side, found.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        if (vertex_count(begin_ + i) < large) found[i].emplace(compute(begin_ + i, alone));
      }
    });
    for (std::size_t i = 0; done && i < found.size(); ++i) {
      if (!found[i]) found[i].emplace(compute(begin_ + i, side_by_side));
    }
    if (!done || context_.cancelled()) return Error{ErrorCode::cancelled, "interrupted while computing", "", ""};
    zones_.clear();
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (*found[i]) {
        zones_.push_back(std::move(**found[i]));
        continue;
      }
      Error error = found[i]->error();
      error.where = group(begin_ + i).name + (error.where.empty() ? "" : ", " + error.where);
      return error;
    }
    return std::monostate{};
  }

  const GroupJob& job_;
  const Context context_;
  std::size_t per_group_, total_;
  std::size_t begin_ = 0, end_ = 0;
  std::vector<Zone> zones_;
};

/// What the file has of a zone.
output::ZoneRow row_of(const Zone& zone, const output::ZoneFileOptions& file, const output::GeometryStyle& style) {
  output::ZoneRow row;
  const output::ZoneFeature feature = output::zone_features(zone, false).front();
  output::Linearizer linearizer(zone.radius(), output::max_error_for(file, zone.radius()));
  row.geometry = style.curves ? output::curve_geometry(zone, feature, false)
                              : output::linear_geometry(zone, feature, false, linearizer, style.sense);
  row.deviation = linearizer.deviation();
  return row;
}

}  // namespace

output::FeatureColumns columns_of(const GroupJob& job) {
  output::FeatureColumns columns;
  if (!job.data.row.empty()) columns.kept = job.data.row.front()->GetDefnRef();
  if (!job.job.features.dissolve_by.empty()) {
    columns.only = {job.job.features.dissolve_by};
    columns.added.push_back({"count", OFTInteger64});
  }
  columns.added.insert(columns.added.end(), {{"radius", OFTReal}, {"area", OFTReal}, {"perimeter", OFTReal}});
  return columns;
}

bool groups_take_arcs(const FeatureOptions& features, const ShapeOptions& shape) {
  return features.owner.empty() && takes_arcs(shape);
}

int write_groups(const GroupJob& job, Session& session) {
  Stopwatch total;
  const std::string in_name = input_name(job.job.input.path), out_name = output_name(job.job.output);
  GroupZones zones(job, session.context("computing"));
  const bool counts = !job.job.features.dissolve_by.empty();
  std::size_t k = 0, empty = 0;
  double area = 0;
  bool failed_before_writing = false;
  const auto next = [&](const output::GeometryStyle& style) -> Result<std::optional<output::ZoneRow>> {
    if (k == zones.total()) return std::optional<output::ZoneRow>{};
    Result<const Zone*> zone = zones.zone(k);
    failed_before_writing = !zone.ok();
    if (!zone) return zone.error();
    output::ZoneRow row = row_of(**zone, job.job.file, style);
    const FeatureGroup& group = zones.group(k);
    row.attributes = group.row;
    if (counts) row.values.push_back(double(group.features.size()));
    row.values.insert(row.values.end(), {(*zone)->signed_radius(), (*zone)->area(), (*zone)->perimeter()});
    area += (*zone)->area();
    empty += (*zone)->ring_count() == 0 ? 1 : 0;
    ++k;
    return std::optional<output::ZoneRow>(std::move(row));
  };
  auto report = output::write_features(job.job.output, job.job.format, job.job.file.crs, columns_of(job), next);
  if (!report) return session.fail(failed_before_writing ? in_name : out_name, report.error());
  tell(*report, job.job, session);
  if (empty > 0) session.note(out_name, fmt::format("note: nothing is left of {} zones: their geometry is empty", empty));
  session.summary(fmt::format("{} features; {} zones, areas {:.10g} in all; {:.3f} s", job.data.size(), zones.total(), area,
                              total.seconds()),
                  job.job.output == "-");
  return 0;
}

}  // namespace krepl::app
