/// Appends cells as CSV: RFC 4180 with plain line feeds, numbers in the shortest text that reads
/// back as the same number, unknown values empty. Pure; any thread.
#pragma once

#include <string>
#include <string_view>

namespace kinescope::app {

class CsvRow {
 public:
  /// Appends to `out`, which is borrowed.
  explicit CsvRow(std::string& out) : out_(out) {}

  /// NaN and infinity: an empty cell.
  void Number(double value);
  void Whole(long long value);
  void Text(std::string_view value);
  void Empty() { Text({}); }
  void End() { out_ += '\n'; }

 private:
  void Separate();

  std::string& out_;
  bool is_first_ = true;
};

}  // namespace kinescope::app
