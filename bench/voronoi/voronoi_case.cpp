// Segment Voronoi diagrams: cost per segment and its growth with n, beside Boost.Polygon on the same lines in the same
// run; then zones at many radii, beside as many runs of the covered-intervals engine.
//
//   voronoi_case [LARGEST_N]    (default 100000; from 10000 in steps of ten)
//
// The lines are bundles of x-monotone meanders that do not cross: Boost.Polygon assumes that, and wants integers of 32
// bits.
#include <sys/resource.h>

#include <boost/polygon/point_data.hpp>
#include <boost/polygon/segment_concept.hpp>
#include <boost/polygon/segment_data.hpp>
#include <boost/polygon/voronoi.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "krepl/voronoi.hpp"

namespace {

using namespace krepl;

double processor_time() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_utime.tv_sec) + 1e-6 * double(usage.ru_utime.tv_usec);
}

std::vector<std::vector<Point>> meanders(std::size_t segments) {
  std::mt19937_64 random(20060401);
  std::uniform_real_distribution<double> unit(-1, 1);
  const std::size_t count = std::size_t(std::sqrt(double(segments)) / 4) + 1, each = segments / count;
  std::vector<std::vector<Point>> lines(count);
  for (std::size_t i = 0; i < count; ++i) {
    double level = 0, slope = 0;
    for (std::size_t k = 0; k <= each; ++k) {
      slope = 0.9 * slope + 60 * unit(random);
      level = 0.98 * level + slope;
      lines[i].push_back({std::round(1000 * (double(k) + 0.3 * unit(random))),
                          std::round(16000 * double(i) + std::clamp(level, -7900.0, 7900.0))});
    }
  }
  return lines;
}

double boost_cost(const std::vector<std::vector<Point>>& lines, std::size_t segments) {
  namespace polygon = boost::polygon;
  std::vector<polygon::segment_data<int>> input;
  for (const auto& line : lines) {
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      input.emplace_back(polygon::point_data<int>(int(line[k].x), int(line[k].y)),
                         polygon::point_data<int>(int(line[k + 1].x), int(line[k + 1].y)));
    }
  }
  const double start = processor_time();
  polygon::voronoi_diagram<double> diagram;
  polygon::construct_voronoi(input.begin(), input.end(), &diagram);
  return (processor_time() - start) * 1e6 / double(segments);
}

void measure(std::size_t wanted) {
  const auto lines = meanders(wanted);
  Network::Builder builder;
  for (const auto& line : lines) builder.add_line(line);
  const auto network = std::make_shared<const Network>(std::move(std::move(builder).build().value()));
  const std::size_t n = network->segments().size();
  Context context;
  context.threads = 1;
  const double start = processor_time();
  const auto diagram = VoronoiDiagram::build(network, context);
  const double built = processor_time();
  if (!diagram) {
    std::printf("%s\n", diagram.error().text().c_str());
    std::exit(1);
  }
  const double boost = boost_cost(lines, n);
  const double krepl = (built - start) * 1e6 / double(n);
  std::printf(
      "n = %8zu: krepl %.2f us a segment, Boost.Polygon %.2f (%.1f times); %.1f candidates a face, %.2g of the faces "
      "again in pairs of doubles\n",
      n, krepl, boost, boost / krepl, double(diagram->counters().candidates) / double(diagram->face_count()),
      double(diagram->counters().faces_in_pairs) / double(diagram->face_count()));
  const int radii = wanted > 100000 ? 10 : 100;
  const double before = processor_time();
  for (int i = 1; i <= radii; ++i) diagram->zone({200.0 * i}, context).value();
  const double between = processor_time();
  for (int i = 1; i <= radii; ++i) compute_zone(network, {200.0 * i}, context).value();
  const double after = processor_time();
  std::printf(
      "  %d radii: %.3f us a segment and radius out of the diagram, %.3f by intervals; all in all %.1f times faster\n",
      radii, (between - before) * 1e6 / double(n) / radii, (after - between) * 1e6 / double(n) / radii,
      (after - between) / (between - before + built - start));
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t largest = argc > 1 ? std::size_t(std::atof(argv[1])) : 100000;
  for (std::size_t n = 10000; n <= largest; n *= 10) measure(n);
}
