#include "voronoi/owner_lobes.hpp"

#include <algorithm>
#include <unordered_map>

#include "model/part_segments.hpp"
#include "zone/polygon_locator.hpp"

namespace krepl::voronoi {

/// The two sides of another segment follow each other in a side's border only where that segment crosses.
void OwnerLobes::cut_faces() {
  lobe_.resize(d_.link_count());
  first_of_face_.assign(d_.face_count() + 1, 0);
  const auto open = [&](Index face, Index link) {
    face_.push_back(face);
    first_.push_back(link);
    last_.push_back(link);
  };
  for (Index f = 0; f < d_.face_count(); ++f) {
    first_of_face_[f] = Index(face_.size());
    const Index begin = d_.begin[f], end = d_.begin[f + 1];
    const bool lonely = begin == end && !in_.is_side(f) && in_.sector(in_.vertex_of(f)).before == f;
    if (lonely) open(f, none);
    for (Index i = begin; i < end; ++i) {
      const bool crossed =
          i > begin && in_.is_side(f) && d_.label[i] != none && in_.is_side(d_.label[i]) && d_.label[i - 1] == (d_.label[i] ^ 1u);
      if (i == begin || crossed) open(f, i);
      last_.back() = i;
      lobe_[i] = Index(face_.size() - 1);
    }
  }
  first_of_face_.back() = Index(face_.size());
}

Index OwnerLobes::twin(Index border) const {
  if (!is_base(border)) return d_.twin[border];
  const Index l = border - d_.link_count(), f = face_[l];
  if (!in_.is_side(f)) return none;  // a vertex has no base
  const Index number = l - first_of_face_[f];  // the other side counts from the other end
  return d_.link_count() + first_of_face_[(f ^ 1u) + 1] - 1 - number;
}

Index OwnerLobes::next(Index border) const {
  const Index l = lobe(border);
  if (is_base(border)) return first_[l];
  if (border != last_[l]) return border + 1;
  return in_.is_side(face_[l]) ? d_.link_count() + l : first_[l];
}

void OwnerLobes::find_site_owners(const Network& network, std::span<const Index> owner) {
  segment_owner_.assign(network.segments().size(), none);
  vertex_owner_.assign(network.vertices().size(), none);
  for (Index p = 0; p < network.part_count(); ++p) {
    for (const Index v : network.part(p)) vertex_owner_[v] = std::min(vertex_owner_[v], owner[p]);
    for_each_segment_of(network, p, [&](Index u, Index v) {
      Index& least = segment_owner_[find_segment(network, u, v)];
      least = std::min(least, owner[p]);
    });
  }
}

/// Halfway between a place of the border and what it is nearest to: no site but the lobe's own is as near.
Point OwnerLobes::place_inside(Index l) const {
  const Index f = face_[l];
  Index best = first_[l];
  for (Index i = first_[l]; i <= last_[l]; ++i) {
    if (d_.clearance[d_.vertex[i]] > d_.clearance[d_.vertex[best]]) best = i;
  }
  const Point p = d_.place[d_.vertex[best]];
  Point foot = in_.vertices()[in_.is_side(f) ? in_.ends(f).from : in_.vertex_of(f)];
  if (in_.is_side(f)) {
    const auto e = in_.ends(f);
    const Vector<double> d = in_.difference<double>(e.to, e.from);
    const double along = ((p.x - foot.x) * d.x + (p.y - foot.y) * d.y) / (d.x * d.x + d.y * d.y);
    foot = {foot.x + along * d.x, foot.y + along * d.y};
  }
  return {(p.x + foot.x) / 2, (p.y + foot.y) / 2};
}

void OwnerLobes::find_owners(const Network& network, std::span<const Index> owner) {
  const Index count = Index(face_.size());
  owner_.resize(count);
  in_polygon_.assign(count, 0);
  for (Index l = 0; l < count; ++l) {
    const Index f = face_[l];
    owner_[l] = in_.is_side(f) ? segment_owner_[f >> 1] : vertex_owner_[in_.vertex_of(f)];
  }
  if (!network.has_polygons()) return;
  std::unordered_map<std::int64_t, Index> owner_of_polygon;
  for (Index p = 0; p < network.part_count(); ++p) {
    if (!network.part_is_ring(p)) continue;
    const auto [at, is_new] = owner_of_polygon.emplace(network.part_feature(p), owner[p]);
    at->second = std::min(at->second, owner[p]);
  }
  const zone::PolygonLocator polygons(network);
  std::vector<std::int64_t> around;
  for (Index l = 0; l < count; ++l) {
    if (first_[l] == none) continue;  // alone in the plane
    polygons.find(place_inside(l), around);
    if (around.empty()) continue;
    in_polygon_[l] = 1;
    owner_[l] = none;
    for (const std::int64_t feature : around) owner_[l] = std::min(owner_[l], owner_of_polygon.at(feature));
  }
}

Status OwnerLobes::find(const Network& network, std::span<const Index> owner) {
  cut_faces();
  for (Index f = 0; f + 1 < in_.side_count(); f += 2) {
    if (first_of_face_[f + 1] - first_of_face_[f] == first_of_face_[f + 2] - first_of_face_[f + 1]) continue;
    const Point p = in_.vertices()[in_.ends(f).from];
    return Error{ErrorCode::computation, "the two sides of a segment are not crossed in the same places",
                 "near x " + std::to_string(p.x) + ", y " + std::to_string(p.y) + " relative to the data's origin",
                 "please report this input"};
  }
  find_site_owners(network, owner);
  find_owners(network, owner);
  return std::monostate{};
}

}  // namespace krepl::voronoi
