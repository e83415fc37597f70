#include "free_rows.hpp"

#include "number_text.hpp"
#include "output/surface_file.hpp"

namespace krepl::app {

namespace {

template <std::size_t count>
void append_numbers(std::string& text, const double (&numbers)[count]) {
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) text += ',';
    append_number(text, numbers[i]);
  }
}

}  // namespace

void DiskRows::append_place(std::string& text, Point p) const { append_numbers(text, {p.x, p.y}); }

void DiskRows::append_contact(std::string& text, const DiskFreeSpace::Contact& contact) const {
  text += contact.at_vertex ? "vertex," : "edge,";
  append_numbers(text, {contact.point.x, contact.point.y});
  text += ',' + std::to_string(contact.source.feature);
}

Status DiskRows::find_components(const std::vector<Place>& places, const Context& context) {
  if (parts == nullptr) return std::monostate{};
  found.resize(places.size());
  return parts->at(places, found, context);
}

void DiskRows::append_component(std::string& text, std::size_t i) const {
  if (parts == nullptr) return;
  text += ',';
  if (found[i] != FreeComponents::none) text += std::to_string(found[i]);
}

void BallRows::append_place(std::string& text, Point3 p) const { append_numbers(text, {p.x, p.y, p.z}); }

void BallRows::append_contact(std::string& text, const BallFreeSpace::Contact& contact) const {
  text += output::name_of(space.terrain().feature_kind(contact.feature));
  text += ',';
  append_numbers(text, {contact.point.x, contact.point.y, contact.point.z});
}

}  // namespace krepl::app
