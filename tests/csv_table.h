/// Reads a CSV file (RFC 4180) by column.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace kinescope::testing {

struct CsvTable {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;

  /// Fails the test if a row has another number of cells than the header.
  explicit CsvTable(const std::string& text) {
    std::vector<std::string> cells(1);
    bool is_quoted = false;
    for (std::size_t at = 0; at < text.size(); ++at) {
      const char c = text[at];
      if (is_quoted && c == '"' && at + 1 < text.size() && text[at + 1] == '"') {
        cells.back() += text[++at];
      } else if (c == '"') {
        is_quoted = !is_quoted;
      } else if (c == ',' && !is_quoted) {
        cells.emplace_back();
      } else if (c == '\n' && !is_quoted) {
        Take(std::move(cells));
        cells = {""};
      } else {
        cells.back() += c;
      }
    }
    EXPECT_FALSE(is_quoted) << "a quote is not closed";
    EXPECT_EQ(cells, std::vector<std::string>{""}) << "the last line does not end";
  }

  const std::string& At(std::size_t row, const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    static const std::string kNone;
    if (found != names.end()) {
      return rows.at(row).at(static_cast<std::size_t>(found - names.begin()));
    }
    ADD_FAILURE() << "no column " << name;
    return kNone;
  }

  /// NaN if the cell is empty.
  double Number(std::size_t row, const std::string& name) const {
    const std::string& cell = At(row, name);
    return cell.empty() ? std::nan("") : std::stod(cell);
  }

 private:
  void Take(std::vector<std::string> cells) {
    if (names.empty()) {
      names = std::move(cells);
      return;
    }
    EXPECT_EQ(cells.size(), names.size()) << "row " << rows.size();
    rows.push_back(std::move(cells));
  }
};

}  // namespace kinescope::testing
