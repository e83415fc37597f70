#pragma once

#include <optional>
#include <vector>

#include "shape/bend_region.hpp"
#include "voronoi/diagram.hpp"

namespace krepl::shape {

/// The links of the faces that a one-sided zone is made of, cut where they leave what the zone holds of the face on either side: all
/// within the radius, or a BendRegion. Seen from its twin, a link has the same pieces in the opposite order.
class FaceLinks {
 public:
  struct Piece {
    Point start, end;
    bool held, held_beyond;  // by the zone in the own face, in the other one
  };

  /// wanted: the faces the zone is made of, by element.
  FaceLinks(const voronoi::Diagram& diagram, const zone::Instance& instance, const std::vector<bool>& wanted,
            const ShapeOptions& options);

  /// Pieces of all links; those of link i are begin(i) .. begin(i + 1).
  const std::vector<Piece>& pieces() const { return pieces_; }
  zone::Index begin(zone::Index link) const { return begin_[link]; }
  /// The same piece of the twin of `link`.
  zone::Index twin(zone::Index link, zone::Index piece) const {
    const zone::Index other = diagram_.twin[link];
    return begin_[other + 1] - 1 - (piece - begin_[link]);
  }
  /// Of a wanted bend's vertex; null where its join is round.
  const BendRegion* region(zone::Index face) const {
    return region_of_.empty() || region_of_[face] == zone::none ? nullptr : &regions_[region_of_[face]];
  }
  /// Whether the link is the perpendicular at one of the site's own ends.
  bool is_perpendicular(zone::Index face, zone::Index link) const;

 private:
  struct Toggle {
    double along;  // of the link, 0 to 1
    Point at;
    bool beyond;  // of the other face
  };

  void add_face(zone::Index face);
  void add_link(zone::Index face, zone::Index link, Point start, Point end);
  bool ends_outside(zone::Index face, zone::Index link) const;
  bool starts_outside(zone::Index face, zone::Index link) const;
  void add_toggles(zone::Index face, zone::Index link, Point start, Point end, bool beyond, std::vector<Toggle>& out) const;

  const voronoi::Diagram& diagram_;
  const zone::Instance& in_;
  const std::vector<bool>& wanted_;
  std::vector<BendRegion> regions_;
  std::vector<zone::Index> region_of_;  // by element
  std::vector<zone::Index> begin_;
  std::vector<Piece> pieces_;
};

}  // namespace krepl::shape
