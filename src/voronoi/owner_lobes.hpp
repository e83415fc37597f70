#pragma once

#include <span>
#include <vector>

#include "krepl/error.hpp"
#include "voronoi/diagram.hpp"

namespace krepl::voronoi {

/// The faces of a diagram cut into *lobes*, each with one owner. A face is one lobe, but for that of a side which others
/// cross: it is pinched there, and a lobe is what lies between two crossings. No segment runs through a lobe, so all of
/// it lies in the same polygons of the network. Inside polygons the lowest of their owners owns it, elsewhere the owner
/// of its site.
///
/// With its base (the stretch of the site's segment) a lobe has a closed border. Borders are numbered: links as in the
/// diagram, then the bases of lobes.
class OwnerLobes {
 public:
  OwnerLobes(const Diagram& diagram, const Instance& instance) : d_(diagram), in_(instance) {}

  /// `owner`: one for each part of the network. ErrorCode::computation if the two sides of a segment are not crossed in
  /// the same places.
  Status find(const Network& network, std::span<const Index> owner);

  Index border_count() const { return Index(d_.link_count() + face_.size()); }
  bool is_base(Index border) const { return border >= d_.link_count(); }
  /// The lobe on the left of a border.
  Index lobe(Index border) const { return is_base(border) ? border - d_.link_count() : lobe_[border]; }
  /// The same border seen from the other side; none at the horizon.
  Index twin(Index border) const;
  /// The border that follows in the same lobe.
  Index next(Index border) const;
  /// True if different owners are on its two sides.
  bool parts_owners(Index border) const {
    const Index t = twin(border);
    return t != none && owner_[lobe(border)] != owner_[lobe(t)];
  }

  Index face(Index lobe) const { return face_[lobe]; }
  /// The lobe of a face that has one only.
  Index only_lobe(Index face) const { return first_of_face_[face]; }
  Index owner(Index lobe) const { return owner_[lobe]; }
  bool in_polygon(Index lobe) const { return in_polygon_[lobe]; }
  /// First and last link of a lobe; precondition: it has any.
  Index first(Index lobe) const { return first_[lobe]; }
  Index last(Index lobe) const { return last_[lobe]; }

 private:
  void cut_faces();
  void find_site_owners(const Network& network, std::span<const Index> owner);
  void find_owners(const Network& network, std::span<const Index> owner);
  Point place_inside(Index lobe) const;

  const Diagram& d_;
  const Instance& in_;
  std::vector<Index> lobe_;           // per link
  std::vector<Index> face_, first_, last_;
  std::vector<Index> first_of_face_;  // lobes of face f: first_of_face_[f] .. first_of_face_[f+1]
  std::vector<Index> segment_owner_, vertex_owner_;
  std::vector<Index> owner_;
  std::vector<char> in_polygon_;
};

}  // namespace krepl::voronoi
