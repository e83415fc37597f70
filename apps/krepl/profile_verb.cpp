// krepl profile: 2D terrain (+) disk.
#include <fmt/format.h>

#include <memory>

#include "input/geometry_source.hpp"
#include "input/profile_reader.hpp"
#include "krepl/profile.hpp"
#include "output_target.hpp"
#include "profile_files.hpp"
#include "stopwatch.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

struct ProfileOptions {
  input::TerrainLineRequest input;
  std::string output, radius, format;
};

struct Format {
  Status (*write)(const std::string& path, const Profile&, const Context&);
};

Result<Format> find_format(const ProfileOptions& options) {
  std::string name = options.format;
  if (name.empty()) name = options.output == "-" ? "csv" : input::format_extension(options.output);
  if (name == "csv") return Format{write_profile_csv};
  if (name == "svg") return Format{write_profile_svg};
  const std::string what = name.empty() ? options.output + " has no extension" : "unknown format '" + name + "'";
  return Error{ErrorCode::usage, what, "", "profiles are written as csv or svg; see --format"};
}

void tell(const Profile& profile, double seconds, Session& session) {
  const ProfileCounters& c = profile.counters;
  session.detail(fmt::format(
      "profile    {:.3f} s: {} segments of positive length, {} pieces hidden by later ones, {} at once on the stack",
      seconds, c.segments, c.pops, c.largest_stack));
  session.detail(
      fmt::format("predicates {} decided with twice the digits, {} of them ties; {} segments repeated between blocks",
                  c.in_double_double, c.ties, c.replayed_segments));
  session.detail(fmt::format("resolution {} pieces collapsed", c.collapsed_pieces));
}

std::string summary_line(const Profile& profile, double seconds) {
  std::size_t arcs = 0;
  for (const ProfilePiece& piece : profile.pieces) arcs += piece.kind == ProfilePiece::Kind::arc;
  const ProfileVertexCounts vertices = count_profile_vertices(profile.terrain, profile.pieces);
  return fmt::format("{} points; {} pieces, {} of them arcs; {} vertices, {} explicit; {:.3f} s", profile.terrain.size(),
                     profile.pieces.size(), arcs, vertices.all, vertices.explicit_ones, seconds);
}

int run_profile(const ProfileOptions& options, Session& session) {
  const Stopwatch total;
  const Result<double> radius = parse_radius(options.radius);
  if (!radius) return session.fail("", radius.error());
  const Result<Format> format = find_format(options);
  if (!format) return session.fail("", format.error());
  if (Status target = check_target(options.output, {options.input.path}); !target)
    return session.fail(options.output, target.error());

  const std::string in_name = input_name(options.input.path);
  const std::string out_name = output_name(options.output);
  Result<input::TerrainLine> data = input::read_terrain_line(options.input, session.context("reading"));
  if (!data) return session.fail(in_name, data.error());
  for (const std::string& note : data->notes) session.note(in_name, note);
  session.detail(fmt::format("read       {:.3f} s: {} points", total.seconds(), data->points.size()));

  const Stopwatch computing;
  const Result<Profile> profile = compute_profile(std::move(data->points), *radius, session.context("computing"));
  if (!profile) return session.fail(in_name, profile.error());
  tell(*profile, computing.seconds(), session);

  const Stopwatch writing;
  if (Status written = format->write(options.output, *profile, session.context("writing")); !written)
    return session.fail(out_name, written.error());
  session.detail(fmt::format("write      {:.3f} s", writing.seconds()));
  session.summary(summary_line(*profile, total.seconds()), options.output == "-");
  return 0;
}

}  // namespace

void add_profile_verb(Verb& program, Session& session) {
  auto options = std::make_shared<ProfileOptions>();
  Verb verb = program.add_verb("profile", "Path of a disk's centre over a 2D terrain, bounded by true arcs");
  verb.add_option("IN", options->input.path, "Terrain: .csv with columns x and z, a line in a vector file, or - (CSV)")
      .required();
  verb.add_option("OUT", options->output, "Result: .csv (a row a piece), .svg, or - (CSV)").required();
  verb.add_option("--radius", options->radius, "Radius of the disk, in the unit of the coordinates")
      .required().type_name("R");
  verb.add_option("--layer", options->input.layer, "Vector files: layer to read").type_name("NAME");
  verb.add_option("--where", options->input.where, "Vector files: the feature to read, as SQL: \"id = 7\"")
      .type_name("CONDITION");
  verb.add_option("--format", options->format, "Format of the result, csv or svg, in place of what its extension says")
      .type_name("NAME");
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_profile(*options, session); });
}

}  // namespace krepl::app
