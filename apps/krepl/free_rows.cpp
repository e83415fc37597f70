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

void BallRows::append_place(std::string& text, Point3 p) const { append_numbers(text, {p.x, p.y, p.z}); }

void BallRows::append_contact(std::string& text, const BallFreeSpace::Contact& contact) const {
  text += output::name_of(space.terrain().feature_kind(contact.feature));
  text += ',';
  append_numbers(text, {contact.point.x, contact.point.y, contact.point.z});
}

}  // namespace krepl::app
