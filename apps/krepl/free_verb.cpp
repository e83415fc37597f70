// krepl free: where a disk or ball may be, how much room it has there, and where motions first cut in.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "free_rows.hpp"
#include "input/motion_reader.hpp"
#include "input/network_reader.hpp"
#include "input/place_stream.hpp"
#include "kernel/parallel.hpp"
#include "network_options.hpp"
#include "number_text.hpp"
#include "output/output_stream.hpp"
#include "output_target.hpp"
#include "route_options.hpp"
#include "stopwatch.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

struct FreeOptions {
  TerrainOptions terrain;       ///< IN of either kind, and its coordinate systems
  input::NetworkRequest plane;  ///< --layer, --where, --arc-error
  std::string radius, places, motions, output;
};

struct Counts {
  std::uint64_t all = 0, free = 0, inside = 0;
};

std::string plural(std::uint64_t count, std::string_view thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

/// Rows of placements: places, free, clearance, contact.
template <class Rows>
Result<Counts> write_places(const Rows& rows, input::PlaceStream& places, output::OutputStream& stream,
                            const std::string& name, Session& session) {
  const Context context = session.context("");
  std::vector<Point3> portion;
  std::vector<typename Rows::Place> local;
  std::vector<typename Rows::Space::Contact> contacts;
  Counts counts;
  stream.write(fmt::format("{},free,clearance,{}\n", Rows::place_columns, Rows::contact_columns));
  std::string text;
  while (!stream.failed()) {
    if (Status got = places.next(portion, context); !got) {
      const Error& error = got.error();
      return Error{error.code, name + ": " + error.what, error.where, error.remedy};
    }
    if (portion.empty()) break;
    local.clear();
    for (const Point3& p : portion) local.push_back(Rows::place(p));
    contacts.resize(local.size());
    if (Status done = rows.space.clearance(local, contacts, context); !done) return done.error();
    text.clear();
    for (std::size_t i = 0; i < local.size(); ++i) {
      const auto& contact = contacts[i];
      ++counts.all, counts.free += contact.free(), counts.inside += contact.clearance < -rows.space.radius();
      rows.append_place(text, local[i]);
      text += contact.free() ? ",1," : ",0,";
      append_number(text, contact.clearance);
      text += ',';
      rows.append_contact(text, contact);
      text += '\n';
    }
    stream.write(text);
  }
  return counts;
}

/// Rows of motions: motion, free, leg, t, places, contact; the latter are empty where a motion is free.
template <class Rows>
Result<Counts> write_motions(const Rows& rows, const input::Motions& motions, output::OutputStream& stream,
                             const Context& context) {
  std::vector<std::optional<typename Rows::Space::Cut>> cuts(motions.size());
  const bool done = kernel::parallel_blocks(context, motions.size(), 1, [&](std::size_t m, std::size_t) {
    std::vector<typename Rows::Place> points;
    for (std::size_t i = motions.begin[m]; i < motions.begin[m + 1]; ++i)
      points.push_back(Rows::place(motions.points[i]));
    cuts[m] = rows.space.first_contact(points);
  });
  if (!done) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  Counts counts;
  std::string text = fmt::format("motion,free,leg,t,{},{}\n", Rows::place_columns, Rows::contact_columns);
  for (std::size_t m = 0; m < motions.size(); ++m) {
    ++counts.all, counts.free += !cuts[m];
    text += motions.name[m];
    if (!cuts[m]) {
      text += Rows::with_z ? ",1,,,,,,,,,\n" : ",1,,,,,,,,\n";
      continue;
    }
    text += fmt::format(",0,{},", cuts[m]->leg);
    append_number(text, cuts[m]->t);
    text += ',';
    rows.append_place(text, cuts[m]->place);
    text += ',';
    rows.append_contact(text, cuts[m]->contact);
    text += '\n';
  }
  stream.write(text);
  return counts;
}

/// Once IN has been read.
template <class Rows>
int run_in(const Rows& rows, const FreeOptions& options, std::optional<input::PlaceStream>& places,
           const Stopwatch& total, Session& session) {
  std::optional<input::Motions> motions;
  if (!places) {
    Result<input::Motions> read = input::read_motions(options.motions, Rows::with_z, session.context("reading"));
    if (!read) return session.fail(input_name(options.motions), read.error());
    motions = std::move(*read);
  }
  Result<output::OutputStream> stream = output::OutputStream::open(options.output);
  if (!stream) return session.fail(output_name(options.output), stream.error());
  const Stopwatch measuring;
  const Result<Counts> counts = places ? write_places(rows, *places, *stream, input_name(options.places), session)
                                       : write_motions(rows, *motions, *stream, session.context("moving"));
  if (!counts) return session.fail("", counts.error());
  if (Status finished = stream->finish(); !finished) return session.fail(output_name(options.output), finished.error());
  session.detail(fmt::format("measure    {:.3f} s, with writing", measuring.seconds()));
  const std::string found = places ? fmt::format("{} free, {} cut in, {} inside",
                                                 plural(counts->all, "place") + ": " + std::to_string(counts->free),
                                                 counts->all - counts->free - counts->inside, counts->inside)
                                   : fmt::format("{}: {} free, {} cut in", plural(counts->all, "motion"), counts->free,
                                                 counts->all - counts->free);
  session.summary(fmt::format("{}; {:.3f} s", found, total.seconds()), options.output == "-");
  return 0;
}

/// A stream of places is opened before IN is read, so that a wrong header is told at once.
template <class Rows>
Result<std::optional<input::PlaceStream>> open_places(const FreeOptions& options, Session& session) {
  if (options.places.empty()) return std::optional<input::PlaceStream>();
  Result<input::PlaceStream> stream = input::PlaceStream::open(options.places, Rows::with_z, session.context(""));
  if (!stream) return stream.error();
  return std::optional<input::PlaceStream>(std::move(*stream));
}

int run_over_terrain(const FreeOptions& options, double radius, const Stopwatch& total, Session& session) {
  const Result<input::TerrainRequest> request = terrain_request(options.terrain);
  if (!request) return session.fail("", request.error());
  auto places = open_places<BallRows>(options, session);
  if (!places) return session.fail(input_name(options.places), places.error());
  const Result<input::TerrainFile> file = input::read_terrain(*request, session.context("reading"));
  if (!file) return session.fail(options.terrain.name(), file.error());
  tell_terrain(*file, options.terrain.name(), total.seconds(), session);
  const Stopwatch building;
  const Result<BallFreeSpace> space = BallFreeSpace::build(file->terrain, radius, session.context("indexing"));
  if (!space) return session.fail(options.terrain.name(), space.error());
  session.detail(fmt::format("index      {:.3f} s", building.seconds()));
  return run_in(BallRows{*space}, options, *places, total, session);
}

/// What is for the other kind of IN, if it is given.
std::optional<Error> refuse_terrain_options(const FreeOptions& options) {
  for (const auto& [name, given] :
       {std::pair{"--z-scale", !options.terrain.z_scale.empty()}, std::pair{"--split", !options.terrain.split.empty()},
        std::pair{"--band", options.terrain.request.band != 0}})
    if (given)
      return Error{ErrorCode::usage, fmt::format("{} is for terrains, but IN is neither a raster nor a mesh", name), "",
                   "leave it out"};
  return std::nullopt;
}
std::optional<Error> refuse_plane_options(const FreeOptions& options) {
  for (const auto& [name, given] :
       {std::pair{"--layer", !options.plane.layer.empty()}, std::pair{"--where", !options.plane.where.empty()},
        std::pair{"--arc-error", options.plane.arc_error != 0}})
    if (given)
      return Error{ErrorCode::usage, fmt::format("{} is for vector files, but IN is a terrain", name), "",
                   "leave it out"};
  return std::nullopt;
}

int run_in_plane(const FreeOptions& options, double radius, const Stopwatch& total, Session& session) {
  input::NetworkRequest request = options.plane;
  request.path = options.terrain.request.path;
  request.crs = options.terrain.request.crs;
  request.to_crs = options.terrain.request.to_crs;
  auto places = open_places<DiskRows>(options, session);
  if (!places) return session.fail(input_name(options.places), places.error());
  const Result<input::NetworkData> data = input::read_network(request, session.context("reading"));
  if (!data) return session.fail(input_name(request.path), data.error());
  for (const std::string& note : data->notes) session.note(input_name(request.path), note);
  const Result<DiskFreeSpace> space = DiskFreeSpace::build(data->network, radius, session.context("indexing"));
  if (!space) return session.fail(input_name(request.path), space.error());
  return run_in(DiskRows{*space}, options, *places, total, session);
}

int run_free(const FreeOptions& options, Session& session) {
  const Stopwatch total;
  const Result<double> radius = parse_radius(options.radius);
  if (!radius) return session.fail("", radius.error());
  const auto wrong = [&](const char* what, const char* remedy) {
    return session.fail("", {ErrorCode::usage, what, "", remedy});
  };
  if (options.places.empty() == options.motions.empty())
    return wrong("give either --at or --motion", "placements, or polylines of them");
  const std::string& asked = options.places.empty() ? options.motions : options.places;
  const std::string& in = options.terrain.request.path;
  if (asked == "-" && in == "-")
    return wrong("IN and the places are both standard input", "name a file for one of them");
  const bool terrain = is_terrain(in);
  if (const auto error = terrain ? refuse_plane_options(options) : refuse_terrain_options(options))
    return session.fail("", *error);
  if (Status target = check_target(options.output, {in, asked}); !target)
    return session.fail(options.output, target.error());
  return terrain ? run_over_terrain(options, *radius, total, session) : run_in_plane(options, *radius, total, session);
}

}  // namespace

void add_free_verb(CLI::App& program, Session& session) {
  auto options = std::make_shared<FreeOptions>();
  CLI::App* verb = program.add_subcommand(
      "free", "Is a disk or ball free at given places, its clearance, and where motions first cut in");
  verb->add_option("IN", options->terrain.request.path,
                   "Obstacles: any OGR vector format, .wkt, .wkb, .gz of them, or -; or a terrain: any GDAL raster, "
                   ".stl .obj .ply .off")
      ->required();
  verb->add_option("--radius", options->radius, "Radius of the disk or ball, in the unit of the coordinates")
      ->required()
      ->type_name("R");
  verb->add_option("--at", options->places,
                   "Placements of the centre: CSV with columns x,y and over a terrain z (others are ignored), or -")
      ->type_name("PTS.csv");
  verb->add_option("--motion", options->motions,
                   "In place of --at: motions of the centre, CSV with the same columns, a row a point; a column motion "
                   "tells them apart")
      ->type_name("LINES.csv");
  verb->add_option("-o,--output", options->output,
                   "Result: CSV; of placements x,y[,z],free,clearance,kind,px,py,pz|feature, or -")
      ->required()
      ->type_name("OUT.csv");
  verb->add_option("--crs", options->terrain.request.crs,
                   "Coordinate system of the data, in place of what the file says")
      ->type_name("EPSG:n");
  verb->add_option("--to-crs", options->terrain.request.to_crs,
                   "Plane coordinate system to take IN to; places are in it; auto chooses one")
      ->type_name("EPSG:n|auto");
  verb->add_option("--layer", options->plane.layer, "Vector: layer to read")->type_name("NAME");
  verb->add_option("--where", options->plane.where, "Vector: features to read, as SQL: \"class = 'wall'\"")
      ->type_name("CONDITION");
  add_arc_option(*verb, options->plane.arc_error);
  verb->add_option("--z-scale", options->terrain.z_scale, "Terrain: multiply heights by this number (default: 1)")
      ->type_name("FACTOR");
  verb->add_option("--split", options->terrain.split,
                   "Raster: diagonal that splits a cell: rising (default), falling, shorter")
      ->type_name("NAME");
  verb->add_option("--band", options->terrain.request.band, "Raster: band to read (default: 1)")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  session.add_common_options(*verb);
  session.on_run(*verb, [options, &session] { return run_free(*options, session); });
}

}  // namespace krepl::app
