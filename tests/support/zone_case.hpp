#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "krepl/curve_zone.hpp"
#include "krepl/shape.hpp"
#include "krepl/zone.hpp"
#include "verify/zone_verifier.hpp"

namespace krepl::test {

using verify::InputPart;

/// An input of a zone and its radius, for tests; can be written down and read again as text.
struct ZoneCase {
  std::vector<InputPart> parts;  ///< with radii of their own, all or none
  double radius = 1;
};

/// The case's radius, or the largest of its parts'.
double largest_radius(const ZoneCase& c);
/// With radii from a short list, so that many are equal and many sums and differences are distances that occur.
ZoneCase varied(ZoneCase c);

/// The parts as one GEOMETRYCOLLECTION with 17 digits, and the radius: enough to repeat the case.
std::string text(const ZoneCase& c);
inline std::ostream& operator<<(std::ostream& out, const ZoneCase& c) { return out << text(c); }

InputPart line(std::vector<Point> vertices);
/// Lines and rings with arcs: where `middles` holds i, vertices i-1, i, i+1 are one.
InputPart curve(std::vector<Point> vertices, std::vector<std::uint32_t> middles);
InputPart curve_ring(std::vector<Point> vertices, std::vector<std::uint32_t> middles, std::int64_t feature = 0);
InputPart ring(std::vector<Point> vertices, std::int64_t feature = 0);
InputPart point(double x, double y);

/// The case as lines with arcs, and its zone by compute_zone of these, whether it has arcs or not.
Result<CurveNetwork> curve_network_of(const ZoneCase& c, const Context& context = {});
Result<Zone> curve_zone_of(const ZoneCase& c, const Context& context = {});

Result<Network> network_of(const ZoneCase& c, const Context& context = {});
Result<Zone> zone_of(const ZoneCase& c, const Context& context = {});

/// A zone as plain pieces, as a reader of its file would see it.
std::vector<input::ResultPolygon> plain(const Zone& zone);

/// What is wrong with the zone: validate(), then all checks of the verifier against the case's input, which share no
/// code with the engine; nothing if it is right. `effort` scales the number of samples.
std::optional<std::string> fault_in(const Zone& zone, const ZoneCase& c, double effort = 0.02);
/// Computes the zone and says what is wrong with it, an error of the computation included.
std::optional<std::string> fault_in(const ZoneCase& c, double effort = 0.02);

/// The zone of a case in some shape; the distance is the case's radius, or minus that.
Result<Zone> shape_of(const ZoneCase& c, const ShapeOptions& options);
/// The same of the case as lines with arcs.
Result<Zone> curve_shape_of(const ZoneCase& c, const ShapeOptions& options);
/// What is wrong with such a zone: validate(), then the verifier's checks; nothing if it is right.
std::optional<std::string> fault_in(const Zone& zone, const ZoneCase& c, const ShapeOptions& options,
                                    double effort = 0.02);
std::string text(const ShapeOptions& options);

/// Number of outer rings and of holes.
struct RingCounts {
  std::size_t outer = 0, holes = 0;
  friend bool operator==(const RingCounts&, const RingCounts&) = default;
};
inline RingCounts counts(const Zone& zone) { return {zone.polygon_count(), zone.hole_count()}; }
std::ostream& operator<<(std::ostream& out, const RingCounts& c);

}  // namespace krepl::test
