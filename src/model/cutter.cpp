#include "krepl/cutter.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

namespace krepl {
namespace {

constexpr const char* grammar =
    "give ball:D, flat:D, bull:D:CORNER_RADIUS, cone:D:ANGLE or taper:D:ANGLE:TIP_RADIUS (D a diameter, ANGLE "
    "included, in "
    "degrees)";
constexpr double least_angle = 1, largest_angle = 179;

std::string number_text(double x) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, x).ptr};
}

Error usage(std::string what, std::string remedy) { return {ErrorCode::usage, std::move(what), "", std::move(remedy)}; }

Status check_length(const char* name, double length) {
  if (std::isfinite(length) && length > 0) return std::monostate{};
  return usage(
      "the tool's " + std::string(name) + " " + number_text(length) + " is not a finite number greater than zero",
      "give one in the unit of the part");
}

Status check_angle(double degrees) {
  if (degrees >= least_angle && degrees <= largest_angle) return std::monostate{};
  return usage("the tool's angle " + number_text(degrees) + " is not between 1 and 179",
               "give the angle between opposite flanks in degrees");
}

struct Form {
  const char* name;
  std::size_t numbers;
};
constexpr std::array<Form, 5> forms{
    {{"ball", 1}, {"flat", 1}, {"bull", 2}, {"cone", 2}, {"taper", 3}}};  // as Cutter::Kind

}  // namespace

Result<Cutter> Cutter::ball(double diameter) {
  if (Status checked = check_length("diameter", diameter); !checked) return checked.error();
  return Cutter(Kind::ball, diameter, 0, diameter / 2);
}

Result<Cutter> Cutter::flat(double diameter) {
  if (Status checked = check_length("diameter", diameter); !checked) return checked.error();
  return Cutter(Kind::flat, diameter, diameter / 2, 0);
}

Result<Cutter> Cutter::bull_nose(double diameter, double corner_radius) {
  if (Status checked = check_length("diameter", diameter); !checked) return checked.error();
  if (Status checked = check_length("corner radius", corner_radius); !checked) return checked.error();
  if (corner_radius > diameter / 2) {
    return usage("the tool's corner radius " + number_text(corner_radius) + " is more than half its diameter " +
                     number_text(diameter),
                 "give a smaller one");
  }
  return Cutter(Kind::bull_nose, diameter, diameter / 2 - corner_radius, corner_radius);
}

Result<Cutter> Cutter::cone(double diameter, double angle) {
  if (Status checked = check_length("diameter", diameter); !checked) return checked.error();
  if (Status checked = check_angle(angle); !checked) return checked.error();
  Cutter cutter(Kind::cone, diameter, 0, 0);
  cutter.set_angle(angle);
  return cutter;
}

Result<Cutter> Cutter::taper(double diameter, double angle, double tip_radius) {
  if (Status checked = check_length("diameter", diameter); !checked) return checked.error();
  if (Status checked = check_angle(angle); !checked) return checked.error();
  if (Status checked = check_length("tip radius", tip_radius); !checked) return checked.error();
  Cutter cutter(Kind::taper, diameter, 0, tip_radius);
  cutter.set_angle(angle);
  if (!(cutter.corner_end() < diameter / 2)) {
    return usage("the tool's tip radius " + number_text(tip_radius) + " leaves no flank within its diameter " +
                     number_text(diameter),
                 "give a smaller tip or a larger diameter");
  }
  return cutter;
}

Result<Cutter> Cutter::parse(std::string_view text) {
  const auto wrong = [&](const std::string& what) {
    return usage("the tool '" + std::string(text.substr(0, 60)) + "' " + what, grammar);
  };
  std::vector<std::string_view> words;
  for (std::string_view rest = text;;) {
    const std::size_t colon = rest.find(':');
    words.push_back(rest.substr(0, colon));
    if (colon == std::string_view::npos) break;
    rest.remove_prefix(colon + 1);
  }
  std::size_t kind = 0;
  while (kind < forms.size() && words[0] != forms[kind].name) ++kind;
  if (kind == forms.size()) return wrong("is of no known kind");
  if (words.size() != forms[kind].numbers + 1) {
    return wrong("has " + std::to_string(words.size() - 1) + " numbers in place of " +
                 std::to_string(forms[kind].numbers));
  }
  double number[3] = {};
  for (std::size_t i = 1; i < words.size(); ++i) {
    const char* const end = words[i].data() + words[i].size();
    const auto [last, status] = std::from_chars(words[i].data(), end, number[i - 1]);
    if (status != std::errc{} || last != end)
      return wrong("has '" + std::string(words[i].substr(0, 40)) + "' for a number");
  }
  switch (Kind(kind)) {
    case Kind::ball:
      return ball(number[0]);
    case Kind::flat:
      return flat(number[0]);
    case Kind::bull_nose:
      return bull_nose(number[0], number[1]);
    case Kind::cone:
      return cone(number[0], number[1]);
    case Kind::taper:
      return taper(number[0], number[1], number[2]);
  }
  return wrong("is of no known kind");
}

std::string Cutter::text() const {
  std::string text = forms[std::size_t(kind_)].name;
  const auto add = [&](double x) { text += ':' + number_text(x); };
  add(diameter_);
  if (kind_ == Kind::cone || kind_ == Kind::taper) add(angle_);
  if (kind_ == Kind::bull_nose || kind_ == Kind::taper) add(corner_);
  return text;
}

void Cutter::set_angle(double degrees) {
  angle_ = degrees;
  slope_ = degrees == 90 ? 1 : 1 / std::tan(degrees * (std::numbers::pi / 360));
}

double Cutter::corner_end() const {
  if (corner_ == 0) return flat_;
  if (std::isinf(slope_)) return radius();
  return flat_ + corner_ * (slope_ / std::sqrt(1 + slope_ * slope_));
}

double Cutter::height(double distance) const {
  if (!(distance <= radius())) return std::numeric_limits<double>::infinity();
  if (distance <= flat_) return 0;
  const double end = corner_end();
  const auto corner = [&](double out) {  // without loss of digits near the flat
    return out * out / (corner_ + std::sqrt(std::max(0.0, (corner_ - out) * (corner_ + out))));
  };
  if (distance <= end) return corner(distance - flat_);
  return (corner_ > 0 ? corner(end - flat_) : 0) + slope_ * (distance - end);
}

}  // namespace krepl
