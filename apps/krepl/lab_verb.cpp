// krepl lab: the thesis's constructions and experiments.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "input/terrain_reader.hpp"
#include "lab/experiments.hpp"
#include "output/output_stream.hpp"
#include "output_target.hpp"
#include "stopwatch.hpp"
#include "terrain_options.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

using lab::Report;

/// What the sub-verbs have in common.
struct LabOptions {
  std::string output;
  std::vector<std::size_t> n;
  std::size_t count = 10000, steps = 2000, restarts = 4;
  std::uint64_t seed = 1;
  double limit = 0;
  std::string radius;
  TerrainOptions terrain;
};

/// The directory that takes the files: there, or to be made in one that is.
Status check_directory(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    return check_target((std::filesystem::path(path) / "krepl").string(), {});
  if (std::filesystem::exists(path, error))
    return Error{ErrorCode::io, "not a directory", "", "give the name of a directory for the files"};
  return check_target(path, {});
}

Status write_files(const std::string& directory, const Report& report) {
  std::error_code error;
  std::filesystem::create_directory(directory, error);
  if (error)
    return Error{ErrorCode::io, "cannot be made: " + error.message(), "", "give a directory in one that is there"};
  for (const lab::Exhibit& file : lab::files_of(report)) {
    auto stream = output::OutputStream::open((std::filesystem::path(directory) / file.file_name).string());
    if (!stream) return stream.error();
    stream->write(file.content);
    if (Status finished = stream->finish(); !finished) return finished.error();
  }
  return std::monostate{};
}

/// Runs an experiment, prints what it found, and writes its files if a directory was given.
int run(const LabOptions& options, Session& session, const std::function<Result<Report>()>& experiment) {
  if (!options.output.empty()) {  // before a long computation rather than after it
    if (Status ready = check_directory(options.output); !ready) return session.fail(options.output, ready.error());
  }
  const Stopwatch watch;
  const Result<Report> report = experiment();
  session.finish_progress();
  if (!report) return session.fail("", report.error());
  session.summary(lab::text_of(report->table));
  for (const std::string& finding : report->findings) session.summary(finding);
  session.detail(fmt::format("computed   {:.3f} s", watch.seconds()));
  if (options.output.empty()) return 0;
  if (Status written = write_files(options.output, *report); !written)
    return session.fail(options.output, written.error());
  session.summary(fmt::format("{}: {} files", options.output, lab::files_of(*report).size()));
  return 0;
}

int run_real(const LabOptions& options, Session& session) {
  const auto radii = parse_radii(options.radius);
  if (!radii) return session.fail("", radii.error());
  const auto request = terrain_request(options.terrain);
  if (!request) return session.fail("", request.error());
  const Stopwatch reading;
  const auto file = input::read_terrain(*request, session.context("reading"));
  session.finish_progress();
  if (!file) return session.fail(options.terrain.name(), file.error());
  tell_terrain(*file, options.terrain.name(), reading.seconds(), session);
  return run(options, session,
             [&] { return lab::crops_experiment(*file->terrain, *radii, session.context("computing")); });
}

/// An experiment as a sub-verb of its own, so that it has only the options that mean something to it.
struct Menu {
  Verb& lab;
  Session& session;

  Verb add(const char* name, const char* what, const std::shared_ptr<LabOptions>& options,
           std::function<int()> work) {
    Verb verb = lab.add_verb(name, what);
    verb.add_option("-o,--output", options->output,
                    "Directory for the table (.csv, .json), terrains (.obj, .csv) and pictures (.svg)")
        .type_name("DIR");
    session.add_common_options(verb);
    session.on_run(verb, std::move(work));
    return verb;
  }
  static void add_sizes(Verb& verb, LabOptions& options, std::vector<std::size_t> sizes, const char* what) {
    options.n = std::move(sizes);
    verb.add_option("--n", options.n, what).separated_by(',').show_default().type_name("N,N...");
  }
  static void add_chance(Verb& verb, LabOptions& options, double limit) {
    options.limit = limit;
    verb.add_option("--seed", options.seed, "Another seed gives other terrains").show_default().type_name("N");
    verb.add_option("--limit", options.limit, "Seconds for one terrain; what takes longer is counted as late")
        .show_default()
        .positive()
        .type_name("SECONDS");
  }
};

void add_constructions(Menu& menu) {
  Session& session = menu.session;
  auto bound = std::make_shared<LabOptions>();
  Verb verb = menu.add("lower-bound", "Section 4.3: grooves and needles, a number of vertices that grows as n^2",
                       bound, [bound, &session] {
                         return run(*bound, session, [&] {
                           return lab::lower_bound_experiment(bound->n, session.context("computing"));
                         });
                       });
  Menu::add_sizes(verb, *bound, {32, 64, 128, 256}, "Grooves and needles together, multiples of 4");
  auto profiles = std::make_shared<LabOptions>();
  verb = menu.add("profiles", "Section 2.3: 2D terrains with 2n + 2 vertices, n - 1 explicit ones, and 3", profiles,
                  [profiles, &session] {
                    return run(*profiles, session,
                               [&] { return lab::profiles_experiment(profiles->n, session.context("computing")); });
                  });
  Menu::add_sizes(verb, *profiles, {8, 100, 1000, 10000, 100000}, "Segments");
  auto sweep = std::make_shared<LabOptions>();
  verb = menu.add("sweep", "Section 3.3, figure 3.6: crossings that a sweep over cigars meets", sweep, [sweep, &session] {
    return run(*sweep, session, [&] { return lab::sweep_experiment(sweep->n, session.context("computing")); });
  });
  Menu::add_sizes(verb, *sweep, {12, 50, 100, 200, 400, 800}, "Reaches of the sub-river");
  auto spheres = std::make_shared<LabOptions>();
  menu.add("pseudospheres", "Figure 4.5: three triangles that four balls touch", spheres, [spheres, &session] {
    return run(*spheres, session, [&] { return lab::pseudospheres_experiment(session.context("computing")); });
  });
  auto components = std::make_shared<LabOptions>();
  menu.add("components", "Theorem 4.5.4: a counter-example", components, [components, &session] {
    return run(*components, session, [&] { return lab::components_experiment(session.context("computing")); });
  });
}

void add_experiments(Menu& menu) {
  Session& session = menu.session;
  auto table = std::make_shared<LabOptions>();
  Verb verb = menu.add("conjecture", "Conjecture 4.5.6: vertices of random terrains against n lambda_2(n)", table,
                       [table, &session] {
                         return run(*table, session, [&] {
                           return lab::conjecture_experiment({table->count, table->n, table->seed, table->limit},
                                                             session.context("computing"));
                         });
                       });
  Menu::add_sizes(verb, *table, {8, 16, 32, 64, 128}, "Triangles");
  Menu::add_chance(verb, *table, 60);
  verb.add_option("--count", table->count, "Terrains in all").show_default().type_name("N");
  auto search = std::make_shared<LabOptions>();
  verb = menu.add(
      "search", "Conjecture 4.5.6: terrains changed step by step to have more vertices", search, [search, &session] {
        return run(*search, session, [&] {
          return lab::search_experiment({search->n, search->steps, search->restarts, search->seed, search->limit},
                                        session.context("climbing"));
        });
      });
  Menu::add_sizes(verb, *search, {4, 8, 16}, "Triangles");
  Menu::add_chance(verb, *search, 10);
  verb.add_option("--steps", search->steps, "Changes tried from each start").show_default().type_name("N");
  verb.add_option("--restarts", search->restarts, "Starts of each family and size")
      .show_default()
      .type_name("N");
  auto real = std::make_shared<LabOptions>();
  verb = menu.add("real", "Parts of an elevation model: vertices against triangles", real,
                  [real, &session] { return run_real(*real, session); });
  add_terrain_options(verb, real->terrain);
  verb.add_option("--radius", real->radius, "Radii of the ball, in the unit of the coordinates")
      .required()
      .type_name("R[,R2,...]");
}

}  // namespace

void add_lab_verb(Verb& program, Session& session) {
  Verb verb = program.add_verb("lab", "The thesis's constructions and experiments");
  verb.require_verb();
  Menu menu{verb, session};
  add_constructions(menu);
  add_experiments(menu);
  const std::vector<Verb::Entry> experiments = verb.verbs();
  Verb list = verb.add_verb("list", "The names of all experiments");
  session.on_run(list, [experiments, &session] {
    for (const Verb::Entry& each : experiments) session.summary(fmt::format("{:<14} {}", each.name, each.what));
    return 0;
  });
}

}  // namespace krepl::app
