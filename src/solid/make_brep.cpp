#include <Standard_Failure.hxx>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

#include "solid/brep_builder.hpp"
#include "solid/columns.hpp"
#include "terrain/curve.hpp"

namespace krepl::solid {

namespace {

using Index = Surface::Index;
using Meeting = Borders::Meeting;
constexpr Index none = Surface::none;

Directed turned(Directed d) { return {d.edge, !d.reversed}; }

class BrepMaker {
 public:
  BrepMaker(const Surface& surface, const BrepOptions& options, const Context& context)
      : surface_(surface),
        options_(options),
        context_(context),
        topology_(surface, options.tolerance),
        borders_(surface, topology_, options.tolerance),
        builder_(surface.terrain().origin(), options.curve_tolerance),
        columns_(surface, topology_, borders_, options.closed ? std::optional<double>(floor_height()) : std::nullopt,
                 builder_) {}

  Result<Brep> make();

 private:
  double floor_height() const { return surface_.terrain().lowest().z - surface_.radius(); }
  Patch patch_of_face(Index h) const {
    return patch_of(surface_.terrain(), surface_.face_feature(topology_.face(h)), surface_.radius());
  }
  void make_edges();
  void make_shared_edge(Index h);
  void make_wall(Index upper);
  int foot(Index lower, const Patch& wall, int top, int from, int to);
  int floor_edge(Index rim, int top, int from, int to);
  Status make_faces();
  Status add_face(Index f);
  void make_floors();
  std::vector<Directed> floor_loop(Index first, std::vector<bool>& done) const;
  double plane_area(const std::vector<Directed>& loop) const;
  void count(BrepCounts& counts) const;

  const Surface& surface_;
  const BrepOptions& options_;
  const Context& context_;
  const Topology topology_;
  const Borders borders_;
  BrepBuilder builder_;
  Columns columns_;
  std::vector<Directed> own_;    // per half-edge: the edge of its face
  std::vector<Directed> floor_;  // per half-edge beside nothing: the edge of the floor
  std::size_t walls_ = 0, floors_ = 0;
};

void BrepMaker::make_edges() {
  own_.resize(topology_.half_edge_count());
  floor_.resize(topology_.half_edge_count());
  for (Index h = 0; h < topology_.half_edge_count(); ++h) {
    if (context_.cancelled()) return;
    if (!topology_.has(h)) continue;
    const Meeting meeting = borders_.meeting(h);
    if (meeting == Meeting::shared && h < topology_.twin(h)) make_shared_edge(h);
    if (meeting != Meeting::shared && borders_.is_upper(h)) make_wall(h);
  }
}

void BrepMaker::make_shared_edge(Index h) {
  const Index t = topology_.twin(h);
  Index from = borders_.corner(h), to = borders_.end_corner(h);
  const bool reversed = h % 2 != 0;
  if (reversed) std::swap(from, to);
  const Curve curve = edge_curve(surface_, h / 2, builder_.corner(int(from)), builder_.corner(int(to)), from == to,
                                 patch_of_face(h), patch_of_face(t), options_.curve_tolerance);
  const int e = builder_.add_edge(curve, int(from), int(to));
  own_[h] = {e, reversed};
  own_[t] = {e, !reversed};
}

/// The upper and the lower edge of a wall or of the outline, and the wall.
void BrepMaker::make_wall(Index upper) {
  const Index lower = topology_.twin(upper);
  const auto is_rim = [&](Index h) { return surface_.edge(h / 2).kind == Surface::EdgeKind::rim; };
  const Index rim = is_rim(upper) ? upper : lower;
  const bool reversed = (rim % 2 != 0) == (rim == upper);
  Index from = borders_.corner(upper), to = borders_.end_corner(upper);
  const Point3 a = builder_.corner(int(from)), b = builder_.corner(int(to));
  if (reversed) std::swap(from, to);
  const Surface::Edge edge = surface_.edge(rim / 2);
  Patch wall;
  if (edge.curve == Surface::Curve::circle) {
    const Index feature = edge.feature[edge.feature[0] == none ? 1 : 0];
    wall =
        wall_cylinder(surface_.terrain().corners(feature).point[0], surface_.radius(), surface_.curve(rim / 2, 3)[1]);
  } else {
    wall = wall_plane(a, b);
  }
  const Curve top_curve = edge_curve(surface_, rim / 2, builder_.corner(int(from)), builder_.corner(int(to)),
                                     from == to, patch_of_face(upper), wall, options_.curve_tolerance);
  const int top = builder_.add_edge(top_curve, int(from), int(to));
  own_[upper] = {top, reversed};

  Directed foot_edge;
  if (borders_.meeting(upper) == Meeting::wall) {
    Index foot_from = borders_.end_corner(lower), foot_to = borders_.corner(lower);
    if (reversed) std::swap(foot_from, foot_to);
    foot_edge = {foot(lower, wall, top, int(foot_from), int(foot_to)), reversed};
    own_[lower] = turned(foot_edge);
  } else {
    if (!options_.closed) return;
    int foot_from = columns_.floor_corner(upper), foot_to = columns_.floor_corner(lower);
    if (reversed) std::swap(foot_from, foot_to);
    foot_edge = {floor_edge(rim, top, foot_from, foot_to), reversed};
    floor_[lower] = turned(foot_edge);
  }
  std::vector<Directed> loop{turned(own_[upper])};
  for (const int e : columns_.edges(upper)) loop.push_back({e, true});
  loop.push_back(foot_edge);
  const std::vector<int>& up = columns_.edges(lower);
  for (auto e = up.rbegin(); e != up.rend(); ++e) loop.push_back({*e, false});
  builder_.add_face(wall, {loop});
  ++walls_;
}

/// The wall's lower edge: the upper one let down onto the lower patch.
int BrepMaker::foot(Index lower, const Patch& wall, int top, int from, int to) {
  const Patch patch = patch_of_face(lower);
  const Point3 a = builder_.corner(from), b = builder_.corner(to);
  if (patch.kind == Patch::Kind::plane && wall.kind == Patch::Kind::plane)
    return builder_.add_edge(line_between(a, b), from, to);
  const Index feature = surface_.face_feature(topology_.face(lower));
  const auto points = [&](int count) {
    std::vector<Point3> found = builder_.points(top, count);
    for (Point3& p : found) p.z = height_over(surface_, feature, p);
    found.front() = a, found.back() = b;
    return found;
  };
  return builder_.add_edge(fit(points, patch, wall, options_.curve_tolerance), from, to);
}

int BrepMaker::floor_edge(Index rim, int top, int from, int to) {
  const Point3 a = builder_.corner(from), b = builder_.corner(to);
  const Surface::Edge edge = surface_.edge(rim / 2);
  if (edge.curve == Surface::Curve::line) return builder_.add_edge(line_between(a, b), from, to);
  const Index feature = edge.feature[edge.feature[0] == none ? 1 : 0];
  Point3 centre = surface_.terrain().corners(feature).point[0], over = builder_.points(top, 5)[from == to ? 1 : 2];
  centre.z = over.z = floor_height();
  return builder_.add_edge(circle_through(centre, {0, 0, 1}, surface_.radius(), {a, over, b, from == to}), from, to);
}

Status BrepMaker::make_faces() {
  for (Index f = 0; f < topology_.face_count(); ++f) {
    if (context_.cancelled()) return Error{ErrorCode::cancelled, "interrupted while writing", "", ""};
    if (context_.progress && f % 256 == 0)
      context_.progress(0.4 * (1 + double(f) / double(topology_.face_count())) / 2);
    if (surface_.face_feature(f) == none || topology_.loops(f).empty()) continue;
    if (Status added = add_face(f); !added) return added;
  }
  return std::monostate{};
}

Status BrepMaker::add_face(Index f) {
  std::vector<std::vector<Directed>> loops;
  for (const Index first : topology_.loops(f)) {
    loops.emplace_back();
    Index h = first;
    do loops.back().push_back(own_[h]);
    while ((h = topology_.next(h)) != first);
  }
  Patch patch = patch_of_face(topology_.loops(f)[0]);
  if (patch.kind == Patch::Kind::sphere) {
    std::vector<Point3> border;
    for (const Directed d : loops[0]) {
      std::vector<Point3> points = builder_.points(d.edge, 17);
      if (d.reversed) std::reverse(points.begin(), points.end());
      border.insert(border.end(), points.begin(), points.end());
    }
    const std::optional<Patch> away = turned_away(patch, border);
    if (!away) {
      const Point3 at = patch.at + surface_.terrain().origin();
      return Error{ErrorCode::computation, "a spherical face is all but a hemisphere",
                   "about " + std::to_string(at.x) + " " + std::to_string(at.y), "take a slightly larger radius"};
    }
    patch = *away;
  }
  builder_.add_face(patch, loops);
  return std::monostate{};
}

/// The floor's border that begins along a half-edge beside nothing; the solid stays on its right.
std::vector<Directed> BrepMaker::floor_loop(Index first, std::vector<bool>& done) const {
  std::vector<Directed> loop;
  Index g = first;
  do {
    done[g] = true;
    loop.push_back(floor_[g]);
    Index h = topology_.twin(g);
    do h = topology_.twin(topology_.previous(h));
    while (surface_.face_feature(topology_.face(h)) != none);
    g = h;
  } while (g != first);
  return loop;
}

double BrepMaker::plane_area(const std::vector<Directed>& loop) const {
  double twice = 0;
  for (const Directed d : loop) {
    const std::vector<Point3> points = builder_.points(d.edge, 17);
    double edge = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
      edge += points[i - 1].x * points[i].y - points[i - 1].y * points[i].x;
    twice += d.reversed ? -edge : edge;
  }
  return twice / 2;
}

void BrepMaker::make_floors() {
  std::vector<Index> parent(topology_.face_count());
  std::iota(parent.begin(), parent.end(), Index{0});
  const auto root = [&](Index f) {
    while (parent[f] != f) f = parent[f] = parent[parent[f]];
    return f;
  };
  const auto beside_nothing = [&](Index h) { return surface_.face_feature(topology_.face(h)) == none; };
  for (Index h = 0; h < topology_.half_edge_count(); ++h) {
    if (!topology_.has(h) || beside_nothing(h) || beside_nothing(topology_.twin(h))) continue;
    parent[root(topology_.face(h))] = root(topology_.face(topology_.twin(h)));
  }
  std::map<Index, std::vector<std::vector<Directed>>> floors;
  std::vector<bool> done(topology_.half_edge_count());
  for (Index h = 0; h < topology_.half_edge_count(); ++h) {
    if (!topology_.has(h) || !beside_nothing(h) || done[h]) continue;
    floors[root(topology_.face(topology_.twin(h)))].push_back(floor_loop(h, done));
  }
  Patch floor;
  floor.at = {0, 0, floor_height()};
  floor.y = {0, -1, 0};
  floor.z = {0, 0, -1};
  for (auto& [part, loops] : floors) {
    const auto larger = [&](const auto& a, const auto& b) {
      return std::fabs(plane_area(a)) < std::fabs(plane_area(b));
    };
    std::iter_swap(loops.begin(), std::max_element(loops.begin(), loops.end(), larger));
    builder_.add_face(floor, loops);
    ++floors_;
  }
}

void BrepMaker::count(BrepCounts& counts) const {
  for (Index f = 0; f < topology_.face_count(); ++f) {
    const Index feature = surface_.face_feature(f);
    if (feature == none || topology_.loops(f).empty()) continue;
    const Terrain::FeatureKind kind = surface_.terrain().feature_kind(feature);
    ++(kind == Terrain::FeatureKind::face   ? counts.planes
       : kind == Terrain::FeatureKind::edge ? counts.cylinders
                                            : counts.spheres);
  }
  counts.walls = walls_, counts.floors = floors_;
  counts.narrow_faces = topology_.lost_faces();
  counts.edges = builder_.edge_count();
  counts.deviation = builder_.deviation();
}

Result<Brep> BrepMaker::make() {
  make_edges();
  if (Status made = make_faces(); !made) return made.error();
  if (options_.closed) make_floors();
  Brep brep;
  brep.shape = builder_.finish(options_.closed, brep.counts.shells);
  count(brep.counts);
  return brep;
}

}  // namespace

Result<Brep> make_brep(const Surface& surface, const BrepOptions& options, const Context& context) {
  try {
    return BrepMaker(surface, options, context).make();
  } catch (const Standard_Failure& failure) {
    return Error{ErrorCode::computation,
                 std::string("OpenCASCADE cannot hold the surface: ") + failure.GetMessageString(), "",
                 "choose a --unit in which the radius is a larger number"};
  }
}

}  // namespace krepl::solid
