#include "server/table/csv_row.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace kinescope::app {

void CsvRow::Separate() {
  if (!is_first_) out_ += ',';
  is_first_ = false;
}

void CsvRow::Number(double value) {
  Separate();
  if (std::isfinite(value)) fmt::format_to(std::back_inserter(out_), "{}", value);
}

void CsvRow::Whole(long long value) {
  Separate();
  fmt::format_to(std::back_inserter(out_), "{}", value);
}

void CsvRow::Text(std::string_view value) {
  Separate();
  if (value.find_first_of(",\"\r\n") == std::string_view::npos) {
    out_ += value;
    return;
  }
  out_ += '"';
  for (const char c : value) {
    if (c == '"') out_ += '"';
    out_ += c;
  }
  out_ += '"';
}

}  // namespace kinescope::app
