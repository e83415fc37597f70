#include "terrain/patches.hpp"

// The same patches in other numbers, each once it is asked for.
namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;

template <class Real>
void PatchSet<Real>::refine(const TerrainWindow& window, const PatchSet<double>& coarse) {
  window_ = &window;
  coarse_ = &coarse;
  radius_ = coarse.radius();
  square_radius_ = radius_ * radius_;
  for (const Index i : loaded_list_) patches_[i] = {}, boxes_[i] = {}, loaded_[i] = false;
  for (const Index e : placed_list_) edges_[e] = {};
  loaded_list_.clear();
  placed_list_.clear();
  bounds_.clear();
  corners_.clear();
  overlaps_.clear();
}

/// Room for all patches. What is there from windows before is empty: few patches are ever loaded.
template <class Real>
void PatchSet<Real>::prepare() {
  if (patches_.size() < coarse_->size()) {
    patches_.resize(coarse_->size());
    boxes_.resize(coarse_->size());
    loaded_.resize(coarse_->size());
  }
  if (edges_.size() < window_->edges().size()) edges_.resize(window_->edges().size());
}

template <class Real>
void PatchSet<Real>::load(std::span<const Index> patches) {
  prepare();
  for (const Index i : patches) load(i);
}

template <class Real>
void PatchSet<Real>::load_with_corners(std::span<const Index> patches) {
  prepare();
  for (const Index i : patches) {
    load_corners(i);
    for (const auto& side : coarse_->bounds(i)) {
      if (side.partner != none) load_corners(side.partner);
    }
  }
}

template <class Real>
void PatchSet<Real>::load_corners(Index i) {
  load(i);
  Patch& p = patches_[i];
  if (p.kind != FeatureKind::vertex || p.corner_count > 0) return;
  for (const Index e : window_->edges_of_vertex(p.item)) place(e);
  set_corners(p, normals_of(p.item));
}

template <class Real>
void PatchSet<Real>::load(Index i) {
  if (loaded_[i]) return;
  loaded_[i] = true;
  loaded_list_.push_back(i);
  const PatchOf<double>& model = (*coarse_)[i];
  Patch& p = patches_[i];
  p.kind = model.kind;
  p.has_rim = model.has_rim;
  p.overlaps = model.overlaps;
  p.feature = model.feature;
  p.item = model.item;
  const BoxOf<double>& box = coarse_->box(i);
  boxes_[i] = {{box.low.x, box.low.y}, {box.high.x, box.high.y}};
  if (p.kind == FeatureKind::vertex) set_vertex(p);
  if (p.kind == FeatureKind::edge) {
    place(p.item);
    set_edge(p);
  }
  if (p.kind == FeatureKind::face) {
    for (const Index e : window_->faces()[p.item].edge) place(e);
    set_face(p);
  }
  p.first_bound = Index(bounds_.size());
  p.bound_count = model.bound_count;
  const auto same = [&](const BoundOf<double>& side) {
    if (side.edge != none) place(side.edge);
    Bound b = bound(p, side.source, side.edge);
    b.negative = side.negative;
    b.partner = side.partner;
    b.rim = side.rim;
    return b;
  };
  for (const BoundOf<double>& side : coarse_->bounds(i)) bounds_.push_back(same(side));
  if (!p.overlaps) return;
  for (const auto& o : coarse_->overlaps_) {
    if (o.patch == i) overlaps_.push_back({i, o.other, same(o.side)});
  }
}

template class PatchSet<double>;
template class PatchSet<DoubleDouble>;

}  // namespace krepl::terrain
