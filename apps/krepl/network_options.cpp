// What all verbs that read lines, polygons and points have in common.
#include "network_options.hpp"


#include "verbs.hpp"

namespace krepl::app {

void add_arc_option(Verb& verb, double& arc_error) {
  verb.add_option("--arc-error", arc_error, "Arcs of the input: take chords that deviate by this much at most (else they stay arcs, or are an error)")
      .type_name("LENGTH")
      .refuse_if([](const std::string& text) {
        const auto parsed = parse_positive("--arc-error", text);
        return parsed ? std::string() : parsed.error().text();
      });
}

void add_network_options(Verb& verb, input::NetworkRequest& input, std::string& format) {
  verb.add_option("--layer", input.layer, "Layer to read").type_name("NAME");
  verb.add_option("--where", input.where, "Features to read, as SQL: \"class = 'river'\"").type_name("CONDITION");
  verb.add_option("--crs", input.crs, "Coordinate system of the data, in place of what the file says")
      .type_name("EPSG:n");
  verb.add_option("--to-crs", input.to_crs, "Plane coordinate system to project the data to; auto chooses one")
      .type_name("EPSG:n|auto");
  add_arc_option(verb, input.arc_error);
  verb.add_option("--format", format, "Format of the result, in place of what its extension says").type_name("NAME");
}

}  // namespace krepl::app
