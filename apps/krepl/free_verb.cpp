// krepl free: where a disk or ball may be, how much room it has there, and where motions first cut in.
#include <fmt/format.h>

#include <memory>

#include "free_rows.hpp"
#include "input/motion_stream.hpp"
#include "input/network_reader.hpp"
#include "input/place_stream.hpp"
#include "kernel/parallel.hpp"
#include "krepl/free_components.hpp"
#include "network_options.hpp"
#include "number_text.hpp"
#include "output/component_file.hpp"
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
  std::string motion_layer, motion_where;
  bool components = false;
  std::string format, max_error;  ///< of components as polygons
};

struct Counts {
  std::uint64_t all = 0, free = 0, inside = 0;
};

std::string plural(std::uint64_t count, std::string_view thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

/// Rows of placements: places, free, clearance, contact.
template <class Rows>
Result<Counts> write_places(Rows& rows, input::PlaceStream& places, output::OutputStream& stream,
                            const std::string& name, Session& session) {
  const Context context = session.context("");
  std::vector<Point3> portion;
  std::vector<typename Rows::Place> local;
  std::vector<typename Rows::Space::Contact> contacts;
  Counts counts;
  stream.write(fmt::format("{},free,clearance,{}{}\n", Rows::place_columns, Rows::contact_columns,
                           rows.components() ? ",component" : ""));
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
    if (Status done = rows.find_components(local, context); !done) return done.error();
    text.clear();
    for (std::size_t i = 0; i < local.size(); ++i) {
      const auto& contact = contacts[i];
      ++counts.all, counts.free += contact.free(), counts.inside += contact.clearance < -rows.space.radius();
      rows.append_place(text, local[i]);
      text += contact.free() ? ",1," : ",0,";
      append_number(text, contact.clearance);
      text += ',';
      rows.append_contact(text, contact);
      rows.append_component(text, i);
      text += '\n';
    }
    stream.write(text);
  }
  return counts;
}

/// The first cut of each motion of a portion.
template <class Rows>
Result<std::vector<std::optional<typename Rows::Space::Cut>>> move(const Rows& rows, const input::Motions& motions,
                                                                   const Context& context) {
  std::vector<std::optional<typename Rows::Space::Cut>> cuts(motions.size());
  const bool done = kernel::parallel_blocks(context, motions.size(), 1, [&](std::size_t m, std::size_t) {
    std::vector<typename Rows::Place> points;
    for (std::size_t i = motions.begin[m]; i < motions.begin[m + 1]; ++i)
      points.push_back(Rows::place(motions.points[i]));
    cuts[m] = rows.space.first_contact(points);
  });
  if (!done) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  return cuts;
}

/// Rows of motions: motion, free, leg, t, places, contact; the latter are empty where a motion is free.
template <class Rows>
Result<Counts> write_motions(const Rows& rows, input::MotionStream& stream, output::OutputStream& out, const std::string& name,
                             Session& session) {
  const Context context = session.context("");
  Counts counts;
  out.write(fmt::format("motion,free,leg,t,{},{}\n", Rows::place_columns, Rows::contact_columns));
  input::Motions motions;
  std::string text;
  while (!out.failed()) {
    if (Status got = stream.next(motions, context); !got) {
      const Error& error = got.error();
      return Error{error.code, name + ": " + error.what, error.where, error.remedy};
    }
    if (motions.size() == 0) break;
    const auto cuts = move(rows, motions, context);
    if (!cuts) return cuts.error();
    text.clear();
    for (std::size_t m = 0; m < motions.size(); ++m) {
      const auto& cut = (*cuts)[m];
      ++counts.all, counts.free += !cut;
      text += motions.name[m];
      if (!cut) {
        text += Rows::with_z ? ",1,,,,,,,,,\n" : ",1,,,,,,,,\n";
        continue;
      }
      text += fmt::format(",0,{},", cut->leg);
      append_number(text, cut->t);
      text += ',';
      rows.append_place(text, cut->place);
      text += ',';
      rows.append_contact(text, cut->contact);
      text += '\n';
    }
    out.write(text);
  }
  return counts;
}

/// Once IN has been read.
template <class Rows>
int run_in(Rows rows, const FreeOptions& options, std::optional<input::PlaceStream>& places,
           const Stopwatch& total, Session& session) {
  std::optional<input::MotionStream> motions;
  if (!places) {
    auto opened = input::MotionStream::open(options.motions, Rows::with_z, options.motion_layer, options.motion_where,
                                            session.context(""));
    if (!opened) return session.fail(input_name(options.motions), opened.error());
    motions = std::move(*opened);
  }
  Result<output::OutputStream> stream = output::OutputStream::open(options.output);
  if (!stream) return session.fail(output_name(options.output), stream.error());
  const Stopwatch measuring;
  const Result<Counts> counts = places ? write_places(rows, *places, *stream, input_name(options.places), session)
                                       : write_motions(rows, *motions, *stream, input_name(options.motions), session);
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
  if (const char* name = options.terrain.given_reading_option()) return for_terrains_only(name);
  return std::nullopt;
}
std::optional<Error> refuse_plane_options(const FreeOptions& options) {
  for (const auto& [name, given] :
       {std::pair{"--layer", !options.plane.layer.empty()}, std::pair{"--where", !options.plane.where.empty()},
        std::pair{"--arc-error", options.plane.arc_error != 0}, std::pair{"--components", options.components}})
    if (given)
      return Error{ErrorCode::usage, fmt::format("{} is for vector files, but IN is a terrain", name), "",
                   "leave it out"};
  return std::nullopt;
}

/// Placements with their components, or the components as polygons.
int run_components(const FreeOptions& options, double radius, const input::NetworkData& data,
                   std::optional<input::PlaceStream>& places, const Stopwatch& total, Session& session) {
  const std::string in = input_name(options.terrain.request.path), out = output_name(options.output);
  const Stopwatch building;
  const Result<FreeComponents> components = FreeComponents::build(data.network, radius, session.context("components"));
  session.finish_progress();
  if (!components) return session.fail(in, components.error());
  session.detail(fmt::format("components {:.3f} s: {}", building.seconds(), components->count()));
  if (places) return run_in(DiskRows{components->space(), &*components}, options, places, total, session);
  const auto format = output::find_zone_format(options.output, options.format);
  if (!format) return session.fail(out, format.error());
  output::ZoneFileOptions file;
  file.crs = data.crs;
  if (!options.max_error.empty()) {
    const auto parsed = parse_positive("--max-error", options.max_error);
    if (!parsed) return session.fail("", parsed.error());
    file.max_error = *parsed;
  }
  const auto report = output::write_components(options.output, components->zone(), *format, file);
  if (!report) return session.fail(out, report.error());
  for (const std::string& note : report->notes) session.note(out, note);
  if (report->deviation)
    session.note(out, fmt::format("note: {} has no arcs: chords deviate by {:.6g} at most", format->name, *report->deviation));
  session.summary(fmt::format("{} of free space, one of them unbounded; {:.3f} s", plural(components->count(), "component"),
                              total.seconds()),
                  options.output == "-");
  return 0;
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
  if (options.components) return run_components(options, radius, *data, *places, total, session);
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
  if (!options.places.empty() && !options.motions.empty())
    return wrong("give either --at or --motion", "placements, or polylines of them");
  if (options.places.empty() && options.motions.empty() && !options.components)
    return wrong("give --at, --motion or --components", "placements, polylines of them, or neither for the parts of free space");
  if (options.components && !options.motions.empty())
    return wrong("--components says nothing of motions", "leave out one of the two");
  if (!options.components || !options.places.empty())
    if (!options.format.empty() || !options.max_error.empty())
      return wrong("--format and --max-error are for components as polygons", "leave them out");
  if (options.motions.empty() && (!options.motion_layer.empty() || !options.motion_where.empty()))
    return wrong("--motion-layer and --motion-where choose motions", "give --motion");
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

void add_free_verb(Verb& program, Session& session) {
  auto options = std::make_shared<FreeOptions>();
  Verb verb = program.add_verb(
      "free", "Is a disk or ball free at given places, its clearance, and where motions first cut in");
  verb.add_option("IN", options->terrain.request.path,
                  "Obstacles: any OGR vector format, .wkt, .wkb, .gz of them, or -; or a terrain: any GDAL raster, "
                  ".stl .obj .ply .off")
      .required();
  verb.add_option("--radius", options->radius, "Radius of the disk or ball, in the unit of the coordinates")
      .required()
      .type_name("R");
  verb.add_option("--at", options->places,
                  "Placements of the centre: CSV with columns x,y and over a terrain z (others are ignored), or -")
      .type_name("PTS.csv");
  verb.add_option("--motion", options->motions,
                  "In place of --at: motions of the centre, lines of any OGR vector format, .wkt, .wkb; or CSV with the same "
                  "columns, a row a point; a column motion tells them apart")
      .type_name("LINES");
  verb.add_option("--motion-layer", options->motion_layer, "Vector: layer of the motions").type_name("NAME");
  verb.add_option("--motion-where", options->motion_where, "Vector: motions to take, as SQL").type_name("CONDITION");
  verb.add_flag("--components", options->components,
                "Plane: with --at, also the connected component of free space that a placement is in, 0 the unbounded one; "
                "without it, the components as polygons");
  verb.add_option("-o,--output", options->output,
                  "Result: CSV; of placements x,y[,z],free,clearance,kind,px,py,pz|feature[,component], or -; of components alone "
                  ".gpkg, .geojson ...")
      .required()
      .type_name("OUT");
  verb.add_option("--crs", options->terrain.request.crs,
                  "Coordinate system of the data, in place of what the file says")
      .type_name("EPSG:n");
  verb.add_option("--to-crs", options->terrain.request.to_crs,
                  "Plane coordinate system to take IN to; places are in it; auto chooses one")
      .type_name("EPSG:n|auto");
  verb.add_option("--layer", options->plane.layer, "Vector: layer to read").type_name("NAME");
  verb.add_option("--where", options->plane.where, "Vector: features to read, as SQL: \"class = 'wall'\"")
      .type_name("CONDITION");
  add_arc_option(verb, options->plane.arc_error);
  verb.add_option("--format", options->format, "Components: format, in place of the extension").type_name("NAME");
  verb.add_option("--max-error", options->max_error,
                  "Components: largest deviation of chords where a format has no arcs (default: R / 1000)")
      .type_name("LENGTH");
  add_reading_options(verb, options->terrain, "Terrain");
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_free(*options, session); });
}

}  // namespace krepl::app
