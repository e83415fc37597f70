// krepl mill: tool paths as G-code.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "boundary_file.hpp"
#include "krepl/cutter.hpp"
#include "krepl/mill.hpp"
#include "output/gcode_file.hpp"
#include "output_target.hpp"
#include "stopwatch.hpp"
#include "terrain_options.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

struct MillVerbOptions {
  TerrainOptions terrain;
  std::string output, tool, strategy = "parallel", direction, post = "linuxcnc", unit = "mm",
                            control_point = "tip";
  std::string boundary, shallow;
  std::string pattern, step_down, ramp_angle, stock_top, stock_margin, steep, valley_angle, shortest, after, threshold;
  std::string step_over, scallop, tolerance, allowance, angle, bottom, safe_height, clearance, feed, plunge_feed,
      spindle;
  int decimals = -1, tool_number = 1;
  bool no_arcs = false;
};

enum class Strategy { parallel, rough, waterline, pencil, scallop, rest };

struct MillPlan {
  Strategy strategy = Strategy::parallel;
  ParallelOptions parallel;  ///< of other strategies what they share with it
  RoughOptions rough;
  WaterlineOptions waterline;
  PencilOptions pencil;
  ScallopOptions scallop;
  RestOptions rest;
  output::GcodeOptions gcode;
  input::TerrainRequest request;
};

Error usage(std::string what, std::string remedy) { return {ErrorCode::usage, std::move(what), "", std::move(remedy)}; }

/// Any finite number for an option.
Result<double> parse_number(const char* option, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value))
    return usage(fmt::format("{} '{}' is not a finite number", option, text), "give one");
  return value;
}

Status take(const char* option, const std::string& text, double& value, bool positive = true) {
  if (text.empty()) return std::monostate{};
  const Result<double> parsed = positive ? parse_positive(option, text) : parse_number(option, text);
  if (!parsed) return parsed.error();
  value = *parsed;
  return std::monostate{};
}

Status take_tool(const std::string& text, MillPlan& plan) {
  const Result<Cutter> cutter = Cutter::parse(text);
  if (!cutter) return cutter.error();
  const bool takes_all =
      plan.strategy == Strategy::parallel || plan.strategy == Strategy::waterline || plan.strategy == Strategy::rough;
  if (cutter->kind() != Cutter::Kind::ball && !takes_all)
    return usage(fmt::format("paths of tool '{}' are made by strategies parallel, waterline and rough only", text),
                 "use one of them, or --tool ball:DIAMETER");
  plan.parallel.tool.radius = cutter->radius();
  if (cutter->kind() != Cutter::Kind::ball) plan.parallel.tool.cutter = *cutter, plan.gcode.has_centre = false;
  plan.gcode.tool_diameter = cutter->diameter();
  plan.gcode.tool_name = cutter->kind() == Cutter::Kind::ball ? "ball-nose" : cutter->text();
  return std::monostate{};
}

template <class Value>
Status choose(const char* option, const std::string& text, std::initializer_list<std::pair<const char*, Value>> choices,
              Value& value) {
  std::string names;
  for (const auto& [name, meaning] : choices) {
    if (text == name) {
      value = meaning;
      return std::monostate{};
    }
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return usage(fmt::format("{} '{}' is unknown", option, text), "give one of " + names);
}

/// Decimals, and what follows from the unit of length and the controller.
Status take_post(const MillVerbOptions& o, MillPlan& plan) {
  using output::GcodePost;
  if (Status s =
          choose("--post", o.post, {{"linuxcnc", GcodePost::linuxcnc}, {"grbl", GcodePost::grbl}}, plan.gcode.post);
      !s)
    return s;
  if (Status s = choose("--unit", o.unit, {{"mm", false}, {"in", true}}, plan.gcode.inches); !s) return s;
  MillAccuracy& a = plan.parallel.accuracy;
  if (Status s = choose("--control-point", o.control_point,
                        {{"tip", ControlPoint::tip}, {"centre", ControlPoint::centre}}, a.control_point);
      !s)
    return s;
  plan.gcode.decimals = o.decimals >= 0 ? o.decimals : plan.gcode.inches ? 5 : 4;
  a.unit = std::pow(10.0, -plan.gcode.decimals);
  a.arcs = !o.no_arcs;
  // GRBL cuts arcs as chords that are within 0.002 mm ($12) of them.
  if (plan.gcode.post == GcodePost::grbl) a.arc_error = plan.gcode.inches ? 0.002 / 25.4 : 0.002;
  a.least_arc_radius = plan.gcode.inches ? 0.0001 : 0.002;
  if (a.control_point == ControlPoint::tip && !plan.parallel.tool.cutter)
    plan.gcode.below_centre = plan.parallel.tool.radius;
  a.tolerance = plan.gcode.inches ? 0.0004 : 0.01;
  return take("--tolerance", o.tolerance, a.tolerance);
}

Status take_motion(const MillVerbOptions& o, MillPlan& plan) {
  MillMotion& m = plan.parallel.motion;
  if (plan.gcode.inches) m.feed = 40, m.plunge_feed = 12, m.rapid_feed = 200;
  if (Status s = take("--feed", o.feed, m.feed); !s) return s;
  if (o.plunge_feed.empty() && !o.feed.empty()) m.plunge_feed = m.feed / 3;
  if (Status s = take("--plunge-feed", o.plunge_feed, m.plunge_feed); !s) return s;
  if (Status s = take("--clearance", o.clearance, m.clearance); !s) return s;
  if (Status s = take("--spindle", o.spindle, plan.gcode.spindle_speed); !s) return s;
  double height = 0;
  if (Status s = take("--safe-height", o.safe_height, height, false); !s) return s;
  if (!o.safe_height.empty()) m.safe_height = height;
  return std::monostate{};
}

/// An option that has no meaning for the strategy would be ignored in silence.
Status check_meaning(const MillVerbOptions& o, Strategy strategy) {
  struct Meaning {
    const char* option;
    const std::string& text;
    bool has_meaning;
    const char* strategies;
  };
  const bool parallel = strategy == Strategy::parallel, rough = strategy == Strategy::rough,
             waterline = strategy == Strategy::waterline, pencil = strategy == Strategy::pencil,
             rest = strategy == Strategy::rest, by_scallop = strategy == Strategy::scallop || rest;
  const Meaning meanings[] = {{"--step-over", o.step_over, parallel || rough, "parallel, rough"},
                              {"--scallop", o.scallop, parallel || by_scallop, "parallel, scallop, rest"},
                              {"--angle", o.angle, parallel || (rough && o.pattern == "zigzag"), "parallel, rough with --pattern zigzag"},
                              {"--direction", o.direction, parallel || waterline, "parallel, waterline"},
                              {"--step-down", o.step_down, rough || waterline, "rough, waterline"},
                              {"--steep", o.steep, waterline, "waterline"},
                              {"--shallow", o.shallow, parallel, "parallel"},
                              {"--boundary", o.boundary, parallel || waterline, "parallel, waterline"},
                              {"--valley-angle", o.valley_angle, pencil || by_scallop, "pencil, scallop, rest"},
                              {"--after", o.after, rest, "rest"},
                              {"--threshold", o.threshold, rest, "rest"},
                              {"--shortest", o.shortest, pencil, "pencil"},
                              {"--bottom", o.bottom, !pencil && !by_scallop, "parallel, rough, waterline"},
                              {"--pattern", o.pattern, rough, "rough"},
                              {"--ramp-angle", o.ramp_angle, rough, "rough"},
                              {"--stock-top", o.stock_top, rough, "rough"},
                              {"--stock-margin", o.stock_margin, rough, "rough"}};
  for (const Meaning& m : meanings)
    if (!m.has_meaning && !m.text.empty())
      return usage(fmt::format("{} has no meaning for strategy {}", m.option, o.strategy),
                   fmt::format("it belongs to {}", m.strategies));
  if (rough && o.step_over.empty()) return usage("--step-over is not given", "give the distance of passes");
  if ((rough || waterline) && o.step_down.empty())
    return usage("--step-down is not given", "give the distance of levels");
  if (by_scallop && o.scallop.empty()) return usage("--scallop is not given", "give the greatest height of what may be left");
  if (rest && o.after.empty()) return usage("--after is not given", "give the larger tool, as ball:DIAMETER");
  return std::monostate{};
}

Status take_rough(const MillVerbOptions& o, MillPlan& plan) {
  const ParallelOptions& p = plan.parallel;
  RoughOptions& r = plan.rough;
  r.tool = p.tool, r.accuracy = p.accuracy, r.motion = p.motion, r.step_over = p.step_over, r.angle = p.angle,
  r.bottom = p.bottom;
  if (!o.pattern.empty())
    if (Status s = choose("--pattern", o.pattern, {{"offsets", RoughPattern::offsets}, {"zigzag", RoughPattern::zigzag}}, r.pattern); !s)
      return s;
  if (Status s = take("--step-down", o.step_down, r.step_down); !s) return s;
  if (Status s = take("--ramp-angle", o.ramp_angle, r.ramp_angle); !s) return s;
  if (Status s = take("--stock-margin", o.stock_margin, r.stock_margin, false); !s) return s;
  double top = 0;
  if (Status s = take("--stock-top", o.stock_top, top, false); !s) return s;
  if (!o.stock_top.empty()) r.stock_top = top;
  return std::monostate{};
}

Status take_waterline(const MillVerbOptions& o, MillPlan& plan) {
  const ParallelOptions& p = plan.parallel;
  WaterlineOptions& w = plan.waterline;
  w.tool = p.tool, w.accuracy = p.accuracy, w.motion = p.motion, w.bottom = p.bottom;
  if (Status s = take("--step-down", o.step_down, w.step_down); !s) return s;
  if (Status s = take("--steep", o.steep, w.steep); !s) return s;
  if (o.direction.empty()) return std::monostate{};
  return choose("--direction", o.direction, {{"climb", true}, {"conventional", false}}, w.climb);
}

Status take_passes(const MillVerbOptions& o, MillPlan& plan) {
  ParallelOptions& p = plan.parallel;
  if (Status s = take("--step-over", o.step_over, p.step_over); !s) return s;
  if (Status s = take("--scallop", o.scallop, p.scallop); !s) return s;
  const bool has_passes = plan.strategy == Strategy::parallel || plan.strategy == Strategy::rough;
  if (has_passes && p.step_over == 0 && p.scallop == 0)
    return usage("neither --step-over nor --scallop is given", "give one of them");
  if (p.step_over != 0 && p.scallop != 0) return usage("both --step-over and --scallop are given", "give one of them");
  if (Status s = take("--angle", o.angle, p.angle, false); !s) return s;
  if (Status s = take("--shallow", o.shallow, p.shallow); !s) return s;
  if (Status s = take("--allowance", o.allowance, p.tool.allowance); !s) return s;
  double bottom = 0;
  if (Status s = take("--bottom", o.bottom, bottom, false); !s) return s;
  if (!o.bottom.empty()) p.bottom = bottom;
  if (plan.strategy != Strategy::parallel || o.direction.empty()) return std::monostate{};
  return choose("--direction", o.direction, {{"zigzag", true}, {"one-way", false}}, p.zigzag);
}

Status take_pencil(const MillVerbOptions& o, MillPlan& plan) {
  const ParallelOptions& p = plan.parallel;
  PencilOptions& v = plan.pencil;
  v.tool = p.tool, v.accuracy = p.accuracy, v.motion = p.motion;
  if (Status s = take("--valley-angle", o.valley_angle, v.valley_angle, false); !s) return s;
  return take("--shortest", o.shortest, v.shortest);
}

Status take_scallop(const MillVerbOptions& o, MillPlan& plan) {
  const ParallelOptions& p = plan.parallel;
  ScallopOptions& s = plan.scallop;
  s.tool = p.tool, s.accuracy = p.accuracy, s.motion = p.motion, s.scallop = p.scallop;
  if (Status taken = take("--valley-angle", o.valley_angle, s.valley_angle, false); !taken) return taken;
  if (plan.strategy != Strategy::rest) return std::monostate{};
  RestOptions& r = plan.rest;
  r.tool = p.tool, r.accuracy = p.accuracy, r.motion = p.motion, r.scallop = p.scallop, r.valley_angle = s.valley_angle;
  const Result<Cutter> larger = Cutter::parse(o.after);
  if (!larger) return larger.error();
  if (larger->kind() != Cutter::Kind::ball)
    return usage(fmt::format("--after '{}' is not a ball-nose cutter", o.after), "give ball:DIAMETER");
  r.after = larger->radius();
  return take("--threshold", o.threshold, r.threshold);
}

Result<MillPlan> make_plan(const MillVerbOptions& o) {
  MillPlan plan;
  if (Status s = choose("--strategy", o.strategy,
                        {{"parallel", Strategy::parallel}, {"rough", Strategy::rough}, {"waterline", Strategy::waterline},
                         {"pencil", Strategy::pencil}, {"scallop", Strategy::scallop}, {"rest", Strategy::rest}},
                        plan.strategy);
      !s)
    return s.error();
  if (Status s = check_meaning(o, plan.strategy); !s) return s.error();
  if (Status s = take_tool(o.tool, plan); !s) return s.error();
  if (Status s = take_post(o, plan); !s) return s.error();
  if (Status s = take_motion(o, plan); !s) return s.error();
  if (Status s = take_passes(o, plan); !s) return s.error();
  if (plan.strategy == Strategy::rough)
    if (Status s = take_rough(o, plan); !s) return s.error();
  if (plan.strategy == Strategy::waterline)
    if (Status s = take_waterline(o, plan); !s) return s.error();
  if (plan.strategy == Strategy::pencil)
    if (Status s = take_pencil(o, plan); !s) return s.error();
  if (plan.strategy == Strategy::scallop || plan.strategy == Strategy::rest)
    if (Status s = take_scallop(o, plan); !s) return s.error();
  plan.gcode.tool_number = o.tool_number;
  plan.gcode.strategy = o.strategy;
  const Result<input::TerrainRequest> request = terrain_request(o.terrain);
  if (!request) return request.error();
  plan.request = *request;
  plan.gcode.part_name = std::filesystem::path(request->path).filename().string();
  return plan;
}

void tell_strategy(const MillReport& r, Strategy strategy, bool by_scallop, Session& session) {
  if (strategy == Strategy::scallop || strategy == Strategy::rest) {
    session.detail(fmt::format("passes     {}, {} more where the scallop would be exceeded; {} points along them", r.passes,
                               r.extra_passes, r.curve_points));
    session.detail(fmt::format("proofs     {} moves are not proven free and taken over what is in their way; {} places where the "
                               "scallop is not proven", r.lifted_moves, r.open_places));
    return;
  }
  if (strategy == Strategy::waterline || strategy == Strategy::pencil) {
    if (strategy == Strategy::waterline)
      session.detail(fmt::format("levels     {}; {} lines, {} points along them, {} rings are too small", r.levels,
                                 r.passes, r.curve_points, r.skipped_cuts));
    else
      session.detail(fmt::format("valleys    {}, {} points along them, {} are too short", r.passes, r.curve_points,
                                 r.skipped_cuts));
    session.detail(fmt::format("proofs     {} moves are not proven free and taken over what is in their way", r.lifted_moves));
    return;
  }
  if (strategy == Strategy::rough) {
    session.detail(fmt::format("levels     {}; {} rings or passes, {:.6g} apart; {} too short to be entered, {} moves left out", r.levels, r.passes,
                               r.step_over, r.skipped_cuts, r.lifted_moves));
    return;
  }
  session.detail(fmt::format("curves     {} points above them, {} bodies looked at", r.curve_points, r.touches));
  session.detail(fmt::format("passes     {}, {:.6g} apart, at {:.6g} degrees", r.passes, r.step_over, r.angle));
  if (by_scallop)
    session.detail(fmt::format("scallops   {} pieces of passes added, {} places where the scallop is not proven", r.extra_passes, r.open_places));
}

void tell(const MillReport& r, Strategy strategy, std::size_t lines, const MillVerbOptions& o, const Stopwatch& total,
          Session& session) {
  tell_strategy(r, strategy, !o.scallop.empty(), session);
  session.summary(
      fmt::format(
          "{} cuts: {} lines, {} arcs, {} rapid moves; {:.6g} {} cut, {:.6g} {} rapid, about {:.1f} min; {} lines of "
          "G-code; {:.3f} s",
          r.cuts, r.lines, r.arcs, r.rapids, r.cutting_length, o.unit, r.rapid_length, o.unit, r.minutes, lines,
          total.seconds()),
      o.output == "-");
}

Result<MilledPath> mill_part(const std::shared_ptr<const Terrain>& part, const MillPlan& plan, const Context& context) {
  switch (plan.strategy) {
    case Strategy::rough: return mill_rough(part, plan.rough, context);
    case Strategy::waterline: return mill_waterline(part, plan.waterline, context);
    case Strategy::pencil: return mill_pencil(part, plan.pencil, context);
    case Strategy::scallop: return mill_scallop(part, plan.scallop, context);
    case Strategy::rest: return mill_rest(part, plan.rest, context);
    case Strategy::parallel: break;
  }
  return mill_parallel(part, plan.parallel, context);
}

int run_mill(const MillVerbOptions& options, Session& session) {
  const Stopwatch total;
  Result<MillPlan> plan = make_plan(options);
  if (!plan) return session.fail("", plan.error());
  if (Status target = options.boundary.empty()
                          ? check_target(options.output, {options.terrain.request.path})
                          : check_target(options.output, {options.terrain.request.path, options.boundary});
      !target)
    return session.fail(options.output, target.error());
  const Result<input::TerrainFile> file = input::read_terrain(plan->request, session.context("reading"));
  if (!file) return session.fail(options.terrain.name(), file.error());
  tell_terrain(*file, options.terrain.name(), total.seconds(), session);
  if (!options.boundary.empty()) {
    const Result<MillBoundary> boundary = read_boundary(options.boundary, session.context("reading"));
    if (!boundary) return session.fail(options.boundary, boundary.error());
    plan->parallel.boundary = plan->waterline.boundary = *boundary;
  }
  const Stopwatch computing;
  const Context context = session.context("milling");
  const Result<MilledPath> milled = mill_part(file->terrain, *plan, context);
  if (!milled)
    return session.fail(milled.error().code == ErrorCode::usage ? "" : options.terrain.name(), milled.error());
  session.detail(fmt::format("path       {:.3f} s", computing.seconds()));
  const Result<std::size_t> lines =
      output::write_gcode(options.output, milled->path, plan->gcode, session.context("writing"));
  if (!lines) return session.fail(output_name(options.output), lines.error());
  tell(milled->report, plan->strategy, *lines, options, total, session);
  return 0;
}

void add_path_options(Verb& verb, MillVerbOptions& o) {
  verb.add_option("--tool", o.tool, "Cutter: ball:D; for parallel, waterline and rough also flat:D, bull:D:CORNER_RADIUS, cone:D:ANGLE, taper:D:ANGLE:TIP_RADIUS").required().type_name("KIND:SIZE");
  verb.add_option("--strategy", o.strategy,
                  "parallel (default): passes in vertical planes; rough: out of a block, level by level; waterline: around the "
                  "part, level by level; pencil: along the valleys and the feet of walls; scallop: all over, at constant distances "
                  "on the surface from valleys and border; rest: such passes where a larger ball has left something")
      .type_name("NAME");
  verb.add_option("--step-over", o.step_over, "Distance of passes").type_name("LENGTH");
  verb.add_option("--scallop", o.scallop, "Greatest height of what is left between passes; parallel: instead of --step-over")
      .type_name("LENGTH");
  verb.add_option("--angle", o.angle, "Direction of passes, degrees from the x axis (default: 0)")
      .type_name("DEGREES");
  verb.add_option("--direction", o.direction, "parallel: zigzag (default) or one-way; waterline: climb (default) or conventional").type_name("NAME");
  verb.add_option("--tolerance", o.tolerance,
                  "Greatest distance of the path above the exact one; it is never below (default: 0.01 mm, 0.0004 in)")
      .type_name("LENGTH");
  verb.add_option("--allowance", o.allowance, "Stock to leave (default: none)").type_name("LENGTH");
  verb.add_option("--bottom", o.bottom,
                  "Lowest Z of the tip; passes go there beside the part (default: the part's lowest place)")
      .type_name("Z");
  verb.add_option("--step-down", o.step_down, "rough, waterline: greatest distance of levels").type_name("LENGTH");
  verb.add_option("--steep", o.steep, "waterline: only where the surface is at least so steep (default: everywhere)")
      .type_name("DEGREES");
  verb.add_option("--shallow", o.shallow,
                  "parallel: only where the surface is less steep, and a step-over beyond (default: everywhere)")
      .type_name("DEGREES");
  verb.add_option("--boundary", o.boundary,
                  "parallel, waterline: the tool's axis stays within the polygons of this vector file")
      .type_name("FILE");
  verb.add_option("--after", o.after, "rest: the larger tool that has been there before: ball:DIAMETER").type_name("KIND:SIZE");
  verb.add_option("--threshold", o.threshold, "rest: what that may have left (default: the scallop)").type_name("LENGTH");
  verb.add_option("--valley-angle", o.valley_angle,
                  "pencil, scallop, rest: least angle between the normals of a valley's sides (default: 20)")
      .type_name("DEGREES");
  verb.add_option("--shortest", o.shortest, "pencil: valleys shorter than that are left out (default: the tool's radius)")
      .type_name("LENGTH");
  verb.add_option("--pattern", o.pattern,
                  "rough: offsets (default): in rings parallel to the part, from outside inwards; zigzag: in parallel passes")
      .type_name("NAME");
  verb.add_option("--ramp-angle", o.ramp_angle, "rough: steepest way down into the stock (default: 3)")
      .type_name("DEGREES");
  verb.add_option("--stock-top", o.stock_top, "rough: top of the block (default: the part's)").type_name("Z");
  verb.add_option("--stock-margin", o.stock_margin,
                  "rough: by how much the block is larger than the part on all sides (default: 0)")
      .type_name("LENGTH");
  verb.add_flag("--no-arcs", o.no_arcs, "Lines only");
}

void add_post_options(Verb& verb, MillVerbOptions& o) {
  verb.add_option("--feed", o.feed, "Units a minute (default: 1000 mm, 40 in)").type_name("F");
  verb.add_option("--plunge-feed", o.plunge_feed, "Downwards (default: a third of the feed)").type_name("F");
  verb.add_option("--spindle", o.spindle, "Revolutions a minute (default: the program leaves the spindle alone)")
      .type_name("S");
  verb.add_option("--safe-height", o.safe_height, "Z at the start and at the end (default: a radius above everything)")
      .type_name("Z");
  verb.add_option("--clearance", o.clearance, "Of rapid moves above the part (default: half the tool's radius)")
      .type_name("LENGTH");
  verb.add_option("--post", o.post, "Controller: linuxcnc (default) or grbl").type_name("NAME");
  verb.add_option("--unit", o.unit, "Unit of the part's coordinates and of the program: mm (default) or in")
      .type_name("UNIT");
  verb.add_option("--decimals", o.decimals, "Of coordinates (default: 4 for mm, 5 for inches)")
      .within(0, output::most_decimals)
      .type_name("N");
  verb.add_option("--control-point", o.control_point, "What Z is the height of: tip (default) or centre of the ball")
      .type_name("NAME");
  verb.add_option("--tool-number", o.tool_number, "T word (default: 1)").within(1, 99999).type_name("N");
}

}  // namespace

void add_mill_verb(Verb& program, Session& session) {
  auto options = std::make_shared<MillVerbOptions>();
  Verb verb = program.add_verb("mill", "Tool paths that never cut into the part, as G-code");
  add_terrain_options(verb, options->terrain);
  verb.add_option("OUT", options->output, "Result: G-code, or -").required();
  add_path_options(verb, *options);
  add_post_options(verb, *options);
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_mill(*options, session); });
}

}  // namespace krepl::app
