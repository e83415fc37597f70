// krepl height: how high a ball or another cutter comes to rest at given places.
#include <fmt/format.h>

#include <array>
#include <memory>

#include "input/place_reader.hpp"
#include "krepl/drop_cutter.hpp"
#include "number_text.hpp"
#include "output/output_stream.hpp"
#include "output/surface_file.hpp"
#include "output_target.hpp"
#include "stopwatch.hpp"
#include "terrain_options.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

using Contact = DropCutter::Contact;

constexpr std::size_t places_at_a_time = std::size_t{1} << 17;

struct HeightOptions {
  TerrainOptions terrain;
  std::string radius, tool, places, output;
};

/// How many places touch a vertex, an edge, a face, or nothing.
using Counts = std::array<std::size_t, 4>;

/// What --radius or --tool asks for; `lift` is what the height of a row is above that of the contact: with --tool rows have
/// the tip's.
struct Asked {
  Cutter cutter;
  double lift = 0;
};
Result<Asked> asked_cutter(const HeightOptions& options) {
  if (options.radius.empty() == options.tool.empty())
    return Error{ErrorCode::usage, "give either --radius or --tool", "", "--radius R is the ball --tool ball:2R"};
  if (!options.tool.empty()) {
    const Result<Cutter> cutter = Cutter::parse(options.tool);
    if (!cutter) return cutter.error();
    return Asked{*cutter, -cutter->control_height()};
  }
  const Result<double> radius = parse_radius(options.radius);
  if (!radius) return radius.error();
  const Result<Cutter> ball = Cutter::ball(2 * *radius);
  if (!ball) return ball.error();
  return Asked{*ball};
}

/// One row: x,y,h,kind,px,py,pz.
void append_row(std::string& text, Point place, const Contact& contact, const Terrain& terrain, double lift,
                Counts& counts) {
  append_number(text, place.x);
  text += ',';
  append_number(text, place.y);
  if (!contact.touches()) {
    ++counts[3];
    text += ",,,,,\n";
    return;
  }
  const Point3 origin = terrain.origin();
  const Terrain::FeatureKind kind = terrain.feature_kind(contact.feature);
  ++counts[std::size_t(kind)];
  text += ',';
  append_number(text, contact.height + (origin.z + lift));
  text += ',';
  text += output::name_of(kind);
  for (const double x : {contact.point.x + origin.x, contact.point.y + origin.y, contact.point.z + origin.z}) {
    text += ',';
    append_number(text, x);
  }
  text += '\n';
}

/// Lowers the tool at all places and writes a row for each, portion by portion.
Result<Counts> write_heights(const std::string& path, const DropCutter& cutter, const std::vector<Point>& places,
                             double lift, const Context& context) {
  Result<output::OutputStream> stream = output::OutputStream::open(path);
  if (!stream) return stream.error();
  Context quiet;
  quiet.threads = context.threads, quiet.cancel = context.cancel;
  const Point3 origin = cutter.terrain().origin();
  std::vector<Point> local;
  std::vector<Contact> contacts;
  Counts counts{};
  std::string text = "x,y,h,kind,px,py,pz\n";
  for (std::size_t first = 0; first < places.size() && !stream->failed(); first += places_at_a_time) {
    const std::size_t last = std::min(first + places_at_a_time, places.size());
    local.clear();
    for (std::size_t i = first; i < last; ++i) local.push_back({places[i].x - origin.x, places[i].y - origin.y});
    contacts.resize(local.size());
    if (Status done = cutter.at(local, contacts, quiet); !done) return done.error();
    for (std::size_t i = first; i < last; ++i)
      append_row(text, places[i], contacts[i - first], cutter.terrain(), lift, counts);
    stream->write(text);
    text.clear();
    if (context.progress) context.progress(double(last) / double(places.size()));
    if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  }
  if (Status finished = stream->finish(); !finished) return finished.error();
  return counts;
}

int run_height(const HeightOptions& options, Session& session) {
  const Stopwatch total;
  const Result<Asked> asked = asked_cutter(options);
  if (!asked) return session.fail("", asked.error());
  const Result<input::TerrainRequest> request = terrain_request(options.terrain);
  if (!request) return session.fail("", request.error());
  if (options.places == "-" && request->path == "-")
    return session.fail("", {ErrorCode::usage, "IN and --at are both standard input", "", "name a file for one of them"});
  if (Status target = check_target(options.output, {request->path, options.places}); !target)
    return session.fail(options.output, target.error());

  const Result<std::vector<Point>> places = input::read_places(options.places, session.context("reading"));
  if (!places) return session.fail(input_name(options.places), places.error());
  const Result<input::TerrainFile> file = input::read_terrain(*request, session.context("reading"));
  if (!file) return session.fail(options.terrain.name(), file.error());
  tell_terrain(*file, options.terrain.name(), total.seconds(), session);

  const Stopwatch building;
  const Result<DropCutter> cutter = DropCutter::build(file->terrain, asked->cutter, session.context("indexing"));
  if (!cutter) return session.fail(options.terrain.name(), cutter.error());
  session.detail(fmt::format("index      {:.3f} s", building.seconds()));
  const Stopwatch dropping;
  const Result<Counts> counts =
      write_heights(options.output, *cutter, *places, asked->lift, session.context("dropping"));
  if (!counts) return session.fail(output_name(options.output), counts.error());
  session.detail(fmt::format("drop       {:.3f} s, with writing", dropping.seconds()));
  session.summary(fmt::format("{} places: {} on a face, {} on an edge, {} on a vertex, {} touch nothing; {:.3f} s",
                              places->size(), (*counts)[2], (*counts)[1], (*counts)[0], (*counts)[3], total.seconds()),
                  options.output == "-");
  return 0;
}

}  // namespace

void add_height_verb(Verb& program, Session& session) {
  auto options = std::make_shared<HeightOptions>();
  Verb verb = program.add_verb(
      "height", "How high a ball or another cutter comes to rest at given places, and what it touches");
  add_terrain_options(verb, options->terrain);
  verb.add_option("--radius", options->radius,
                  "Radius of a ball, in the unit of the coordinates; h is its centre's height")
      .type_name("R");
  verb.add_option("--tool", options->tool,
                  "Cutter in place of --radius: ball:D, flat:D, bull:D:CORNER_RADIUS, cone:D:ANGLE or "
                  "taper:D:ANGLE:TIP_RADIUS; h is its tip's height")
      .type_name("TOOL");
  verb.add_option("--at", options->places, "Places: CSV with columns x and y (others are ignored), or -")
      .required().type_name("PTS.csv");
  verb.add_option("-o,--output", options->output, "Result: CSV with columns x,y,h,kind,px,py,pz, or -")
      .required().type_name("OUT.csv");
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_height(*options, session); });
}

}  // namespace krepl::app
