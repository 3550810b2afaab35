/// Files of measured forces from literals.
#pragma once

#include <cstdio>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "server/wrenches/wrench_reader.h"

namespace kinescope::wrenches::testing {

constexpr char kHeader[] = "time_s,body,fx_N,fy_N,fz_N,px_m,py_m,pz_m,tx_Nm,ty_Nm,tz_Nm\n";

/// All rows of `text`, as a file with the name forces.csv or forces.mot.
inline std::vector<WrenchRow> ReadRows(std::string text, WrenchFormat format,
                                       const WrenchSettings& settings = {}) {
  const bool is_empty = text.empty();
  if (is_empty) text = " ";  // fmemopen takes no empty buffer
  InputFile file(fmemopen(text.data(), text.size(), "rb"));
  if (is_empty) std::fgetc(file.get());
  const auto reader =
      ReadWrenches(std::move(file), format == WrenchFormat::kCsv ? "forces.csv" : "forces.mot",
                   format, settings);
  std::vector<WrenchRow> rows;
  while (auto row = reader->Next()) rows.push_back(*row);
  return rows;
}

inline std::vector<WrenchRow> ReadCsv(const std::string& rows,
                                      const WrenchSettings& settings = {}) {
  return ReadRows(kHeader + rows, WrenchFormat::kCsv, settings);
}

inline void WriteText(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace kinescope::wrenches::testing
