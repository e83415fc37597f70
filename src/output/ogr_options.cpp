#include "output/ogr_options.hpp"

#include <cstdlib>
#include <ctime>

namespace krepl::output {

std::string file_date(const char* pattern) {
  const char* epoch = std::getenv("SOURCE_DATE_EPOCH");
  std::time_t seconds = epoch != nullptr ? static_cast<std::time_t>(std::strtoll(epoch, nullptr, 10)) : 0;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char text[64];
  std::strftime(text, sizeof text, pattern, &utc);
  return text;
}

}  // namespace krepl::output
