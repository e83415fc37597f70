#include <string>

#include "kernel/pages.hpp"
#include "kernel/parallel.hpp"
#include "zone/crossing.hpp"
#include "zone/rings.hpp"

namespace krepl::zone {
namespace {

constexpr std::size_t block = 1 << 14;

/// first[e] .. first[e+1): the pieces of element e.
std::vector<Index> pieces_by_element(const Instance& instance, const std::vector<Piece>& pieces) {
  std::vector<Index> first(std::size_t{instance.element_count()} + 1, 0);
  Index element = 0;
  for (Index i = 0; i < pieces.size(); ++i) {
    while (element <= pieces[i].element) first[element++] = i;
  }
  while (element < first.size()) first[element++] = Index(pieces.size());
  return first;
}

std::string coordinates(Point p) { return "x " + std::to_string(p.x) + ", y " + std::to_string(p.y); }

Error unmatched(const Instance& instance, const Piece& p) {
  const Point at = crossing(instance, p.element, p.to);
  return {ErrorCode::computation,
          "the boundary could not be certified: element " + std::to_string(p.element) + " (from " + std::to_string(p.from) +
              ") ends on element " + std::to_string(p.to) + " which does not continue it",
          "near " + coordinates(at) + " relative to the data's origin", "please report this input"};
}

/// For each piece the one that continues it: on the element `to`, coming from `element`.
Result<std::vector<Index>> successors(const Instance& instance, const std::vector<Piece>& pieces, const Context& context) {
  const std::vector<Index> first = pieces_by_element(instance, pieces);
  std::vector<Index> next;
  kernel::resize_pages(context, next, pieces.size(), none);
  Context quiet;
  quiet.threads = context.threads;
  kernel::parallel_blocks(quiet, pieces.size(), block, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      for (Index j = first[pieces[i].to]; j < first[pieces[i].to + 1]; ++j) {
        if (pieces[j].from == pieces[i].element) next[i] = j;
      }
    }
  });
  std::vector<bool> reached(pieces.size(), false);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (next[i] == none || reached[next[i]]) return unmatched(instance, pieces[i]);
    reached[next[i]] = true;
  }
  return next;
}

}  // namespace

Result<Rings> link_pieces(const Instance& instance, const std::vector<Piece>& pieces, const Context& context) {
  auto linked = successors(instance, pieces, context);
  if (!linked) return linked.error();
  std::vector<Index>& next = *linked;
  Rings rings;
  std::vector<Index> order;  // pieces, ring by ring
  kernel::reserve_pages(context, order, pieces.size());
  for (Index i = 0; i < pieces.size(); ++i) {
    if (next[i] == none) continue;
    for (Index j = i; next[j] != none;) {
      order.push_back(j);
      const Index following = next[j];
      next[j] = none;
      j = following;
    }
    rings.begin.push_back(Index(order.size()));
  }
  next = {};
  kernel::resize_pages(context, rings.element, pieces.size());
  kernel::resize_pages(context, rings.vertex, pieces.size());
  Context quiet;
  quiet.threads = context.threads;
  kernel::parallel_blocks(quiet, pieces.size(), block, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      const Piece& p = pieces[order[i]];
      rings.element[i] = p.element;
      rings.vertex[i] = crossing(instance, p.from, p.element);
    }
  });
  return rings;
}

}  // namespace krepl::zone
