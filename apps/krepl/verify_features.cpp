// krepl verify of zones of features or groups, and of shares of owners.
#include "verify_features.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "feature_zones.hpp"
#include "input/result_file.hpp"
#include "shape_options.hpp"
#include "verify/owner_verifier.hpp"

namespace krepl::app {

namespace {

using Parts = std::vector<verify::InputPart>;

Parts parts_of(const input::FeatureData& data, const FeatureGroup& group) {
  Parts parts;
  for (const std::size_t f : group.features) {
    for (std::size_t i = data.part_begin[f]; i < data.part_begin[f + 1]; ++i) {
      const auto first = data.parts.points.begin() + std::ptrdiff_t(data.parts.begin[i]);
      const auto last = data.parts.points.begin() + std::ptrdiff_t(data.parts.begin[i + 1]);
      parts.push_back({{first, last},
                       data.parts.kind[i] == input::Parts::Kind::ring,
                       std::int64_t(f),
                       data.radius.empty() ? 0 : data.radius[f],
                       data.parts.middles_of(i)});
    }
  }
  return parts;
}

/// One line for all checks of one name: what was tested and broken in all, the worst by its own limit.
void add(std::vector<verify::Check>& total, const std::vector<verify::Check>& checks) {
  for (const verify::Check& c : checks) {
    const auto known = std::find_if(total.begin(), total.end(), [&](const auto& t) { return t.name == c.name; });
    if (known == total.end()) {
      total.push_back(c);
      total.back().note.clear();
      continue;
    }
    known->tested += c.tested, known->violations += c.violations;
    if (c.worst * known->limit > known->worst * c.limit || (c.limit == known->limit && c.worst > known->worst))
      known->worst = c.worst, known->limit = c.limit, known->where = c.where;
  }
}

/// The zones in the file's order, and what they belong to.
struct Loaded {
  input::FeatureData data;
  std::vector<FeatureGroup> groups;
  std::vector<input::ResultZone> zones;
  std::size_t per_group() const { return zones.size() / groups.size(); }
};

Result<Loaded> load(const FeatureVerification& job, Session& session, bool& fault_of_result) {
  Loaded all;
  const verify::InputRequest& in = job.input;
  fault_of_result = false;
  input::FeatureRequest request{verify::network_request(in), in.radius_field, in.radius_expression, job.features.dissolve_by};
  request.network.keep_arcs = groups_take_arcs(job.features, job.shape);
  auto data = input::read_features(request, session.context("reading"));
  session.finish_progress();
  if (!data) return data.error();
  all.data = std::move(*data);
  all.groups = make_groups(all.data, job.features.dissolve_by);
  fault_of_result = true;
  // Shrunk polygons may be gone; every feature has its row all the same.
  auto zones = input::read_zone_features(job.result, input::EmptyZones::keep);
  if (!zones) return zones.error();
  all.zones = std::move(*zones);
  if (all.zones.empty() || all.zones.size() % all.groups.size() != 0) {
    return Error{ErrorCode::input,
                 fmt::format("holds {} zones for {} {}", all.zones.size(), all.groups.size(),
                             job.features.dissolve_by.empty() ? "features" : "groups"),
                 "", "give the input and the options that the result was made with"};
  }
  return all;
}

Result<double> radius_of(const FeatureVerification& job, const Loaded& all, std::size_t k, const Parts& parts) {
  double largest = 0;
  for (const verify::InputPart& part : parts) largest = std::max(largest, part.radius);
  if (largest > 0) return largest;
  if (!job.radii.empty()) return job.radii[k % job.radii.size()];
  if (all.zones[k].radius) return *all.zones[k].radius;
  return Error{ErrorCode::usage, "the result does not tell its radius", "", "give one with --radius"};
}

Result<verify::ZoneReport> check_one(const std::vector<input::ResultPolygon>& polygons, const Parts& parts,
                                     const ShapeOptions& shape, const verify::ZoneCheckOptions& options,
                                     const Context& context) {
  if (is_plain(shape, {options.radius}))
    return verify::check_zone(polygons, verify::Obstacle(parts, options.radius), options, context);
  verify::ZoneCheckOptions check = options;
  if (check.max_error == 0) check.max_error = border_chords(shape, options.radius);
  return verify::check_shape(polygons, parts, shape_question(shape, options.radius), check, context);
}

Result<std::vector<verify::Check>> check_groups(const FeatureVerification& job, const Loaded& all, std::string& broken,
                                                Session& session) {
  std::vector<verify::Check> total;
  verify::ZoneCheckOptions options;
  options.max_error = job.max_error;
  const std::size_t n = all.zones.size();
  options.samples = std::max<std::uint64_t>(200, (job.samples != 0 ? job.samples : 1'000'000) / n);
  options.samples = std::min<std::uint64_t>(options.samples, 20'000);
  options.effort = std::clamp(100.0 / double(n), 0.005, 1.0);
  const Context context = session.context("checking");
  Context quiet = context;
  quiet.progress = {};
  for (std::size_t k = 0; k < n; ++k) {
    if (context.progress) context.progress(double(k) / double(n));
    const FeatureGroup& group = all.groups[k / all.per_group()];
    const Parts parts = parts_of(all.data, group);
    const Result<double> radius = radius_of(job, all, k, parts);
    if (!radius) return radius.error();
    options.radius = *radius;
    auto report = check_one(all.zones[k].polygons, parts, job.shape, options, quiet);
    if (!report) return report.error();
    if (!report->ok() && broken.empty()) broken = group.name;
    add(total, report->checks);
  }
  return total;
}

Result<std::vector<verify::Check>> check_shares(const FeatureVerification& job, const Loaded& all, Session& session) {
  std::vector<Parts> owners;
  for (const FeatureGroup& group : all.groups) owners.push_back(parts_of(all.data, group));
  std::vector<verify::Check> total;
  for (std::size_t r = 0; r < all.per_group(); ++r) {
    const Result<double> radius = radius_of(job, all, r, {});
    if (!radius) return radius.error();
    std::vector<std::vector<input::ResultPolygon>> shares;
    for (std::size_t g = 0; g < owners.size(); ++g) shares.push_back(all.zones[g * all.per_group() + r].polygons);
    verify::OwnerCheckOptions options;
    options.radius = *radius;
    options.max_error = job.max_error > 0 ? job.max_error : *radius / 1000;
    if (job.samples != 0) options.samples = job.samples;
    auto checks = verify::check_owners(owners, shares, options, session.context("checking"));
    if (!checks) return checks.error();
    add(total, *checks);
  }
  return total;
}

}  // namespace

int verify_features(const FeatureVerification& job, Session& session) {
  bool fault_of_result = false;
  Result<Loaded> all = load(job, session, fault_of_result);
  if (!all) return session.fail(fault_of_result ? job.result : job.input.path, all.error());
  std::string broken;
  const auto checks =
      job.features.owner.empty() ? check_groups(job, *all, broken, session) : check_shares(job, *all, session);
  session.finish_progress();
  if (!checks) return session.fail(job.result, checks.error());
  session.summary(fmt::format("{} zones of {} {}", all->zones.size(), all->groups.size(),
                              job.features.dissolve_by.empty() ? "features" : "groups"));
  print_checks(session, *checks);
  Error error{ErrorCode::computation, "", broken, ""};
  for (const verify::Check& check : *checks) {
    if (!check.ok()) error.what += (error.what.empty() ? "" : ", ") + check.name;
  }
  if (!error.what.empty()) {
    error.what = "does not hold the zones of the features: " + error.what;
    if (job.max_error == 0) error.remedy = "for a format without arcs give --max-error";
    return session.fail(job.result, error);
  }
  session.summary("sound: every check passed");
  return 0;
}

}  // namespace krepl::app
