// Caps, joins, sides, rings and negative radii of zones: options, and what `krepl buffer` does about them.
#include "shape_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "krepl/curve_zone.hpp"
#include "stopwatch.hpp"

namespace krepl::app {

namespace {

template <class Choice>
Result<Choice> choose(const char* option, const std::string& text,
                      std::initializer_list<std::pair<const char*, Choice>> known) {
  if (text.empty()) return known.begin()->second;
  std::string names;
  for (const auto& [name, choice] : known) {
    if (text == name) return choice;
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return Error{ErrorCode::usage, fmt::format("{} '{}' is unknown", option, text), "", "give " + names};
}

std::string text_of(RingFault::Kind kind) {
  switch (kind) {
    case RingFault::Kind::crossing:
      return "sides cross";
    case RingFault::Kind::touching:
      return "a ring touches itself";
    case RingFault::Kind::overlapping:
      return "sides run along each other";
    case RingFault::Kind::direction:
      return "a hole runs the same way round as an outer ring";
    case RingFault::Kind::collapsed:
      return "a ring encloses nothing";
  }
  return "";
}

template <class AnyNetwork>
Status tell_faults(const AnyNetwork& network, const std::string& in_name, Session& session) {
  constexpr std::size_t most = 10;
  const auto faults = check_rings(network, session.context("checking rings"));
  session.finish_progress();
  if (!faults) return faults.error();
  for (std::size_t i = 0; i < std::min(most, faults->size()); ++i) {
    const RingFault& f = (*faults)[i];
    session.note(in_name, fmt::format("note: feature {}: {}, {} {:.12g} {:.12g}{}", f.feature, text_of(f.kind),
                                      f.count > 1 ? "first at" : "at", f.where.x, f.where.y,
                                      f.count > 1 ? fmt::format(" ({} places)", f.count) : ""));
  }
  if (faults->size() > most) session.note(in_name, fmt::format("note: {} more faults of rings", faults->size() - most));
  const bool crossed = std::any_of(faults->begin(), faults->end(), [](const RingFault& f) {
    return f.kind != RingFault::Kind::direction && f.kind != RingFault::Kind::collapsed;
  });
  if (crossed) session.note(in_name, "note: what an odd number of rings of a feature enclose counts as inside");
  return std::monostate{};
}

void tell(const Zone& zone, double seconds, Session& session) {
  const ZoneCounters& c = zone.counters();
  session.detail(fmt::format("shape      {:.3f} s: radius {}, {} pieces, {} rings ({} holes), {} polygons", seconds,
                             zone.signed_radius(), zone.piece_count(), zone.ring_count(), zone.hole_count(),
                             zone.polygon_count()));
  if (c.elements == 0) return;
  session.detail(
      fmt::format("predicates {} decided in double precision, {} in quadruple; {} pieces collapsed, {} rings dropped",
                  c.elements_in_double, c.elements_in_quadruple, c.collapsed_pieces, c.dropped_rings));
}

}  // namespace

Status tell_ring_faults(const Network& network, const std::string& in_name, Session& session) {
  return tell_faults(network, in_name, session);
}

Status tell_ring_faults(const CurveNetwork& network, const std::string& in_name, Session& session) {
  return tell_faults(network, in_name, session);
}

bool takes_arcs(const ShapeOptions& shape) { return shape.side == Side::both; }

void add_shape_options(Verb& verb, ShapeArguments& shape) {
  verb.add_option("--cap", shape.cap, "Ends of lines: round, flat, square").type_name("NAME");
  verb.add_option("--join", shape.join, "Outer sides of bends: round, mitre, bevel").type_name("NAME");
  verb.add_option("--mitre-limit", shape.mitre_limit, "Longest mitre, in radii from its corner (default: 5)")
      .type_name("RATIO");
  verb.add_option("--side", shape.side, "Zone on one side of lines only: both, left, right").type_name("NAME");
  verb.add_flag("--ring", shape.ring,
                "Zone without the polygons of the input; negative radius: what shrinking takes off");
}

Result<ShapeOptions> parse_shape(const ShapeArguments& shape) {
  ShapeOptions options;
  const auto cap =
      choose<Cap>("--cap", shape.cap, {{"round", Cap::round}, {"flat", Cap::flat}, {"square", Cap::square}});
  if (!cap) return cap.error();
  const auto join =
      choose<Join>("--join", shape.join, {{"round", Join::round}, {"mitre", Join::mitre}, {"bevel", Join::bevel}});
  if (!join) return join.error();
  const auto side =
      choose<Side>("--side", shape.side, {{"both", Side::both}, {"left", Side::left}, {"right", Side::right}});
  if (!side) return side.error();
  if (*side != Side::both && shape.cap == "round")
    return Error{ErrorCode::usage, "a one-sided zone ends straight across", "", "leave --cap out"};
  if (!shape.mitre_limit.empty()) {
    if (*join != Join::mitre)
      return Error{ErrorCode::usage, "--mitre-limit goes with --join mitre", "", "give both or none"};
    const auto limit = parse_positive("--mitre-limit", shape.mitre_limit);
    if (!limit) return limit.error();
    if (*limit < 1) return Error{ErrorCode::usage, "--mitre-limit is below 1", "", "give a ratio of 1 or more"};
    options.mitre_limit = *limit;
  }
  options.cap = *cap, options.join = *join, options.side = *side, options.ring = shape.ring;
  return options;
}

bool is_plain(const ShapeOptions& shape, const std::vector<double>& radii) {
  return shape.cap == Cap::round && shape.join == Join::round && shape.side == Side::both && !shape.ring &&
         std::all_of(radii.begin(), radii.end(), [](double r) { return r > 0; });
}

Result<std::vector<double>> parse_signed_radii(std::string_view text) {
  std::vector<double> radii;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    begin = end + 1;
    const bool negative = word.size() > 1 && word[0] == '-' && word.find(':') == word.npos;
    const auto parsed = parse_radii(negative ? word.substr(1) : word);
    if (!parsed) return parse_radii(word).error();  // names what was typed
    for (const double r : *parsed) radii.push_back(negative ? -r : r);
  }
  return radii;
}

Result<std::vector<Zone>> shaped_zones(const input::NetworkData& data, const std::vector<double>& radii,
                                       const ShapeOptions& shape, const std::string& in_name, Session& session) {
  if (data.network->has_polygons()) {
    const Status told = data.curves ? tell_ring_faults(*data.curves, in_name, session)
                                    : tell_ring_faults(*data.network, in_name, session);
    if (!told) return told.error();
  }
  std::vector<Zone> zones;
  for (const double radius : radii) {
    Stopwatch watch;
    ShapeOptions options = shape;
    options.distance = radius;
    const Context context = session.context("computing");
    auto zone = data.curves ? compute_shape(data.curves, options, context) : compute_shape(data.network, options, context);
    if (!zone) return zone.error();
    tell(*zone, watch.seconds(), session);
    if (zone->ring_count() == 0)
      session.note(in_name, fmt::format("note: nothing is left at radius {}: the zone is empty", radius));
    zones.push_back(std::move(*zone));
  }
  return zones;
}

}  // namespace krepl::app
