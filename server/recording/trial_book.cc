#include "server/recording/trial_book.h"

#include <algorithm>
#include <exception>
#include <fstream>
#include <iterator>

#include "render/image/new_file.h"

namespace kinescope::recording {
namespace {

// Of the file that is this trial's and not a copy under another name.
std::optional<Trial> ReadTrialFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text(TrialBook::kMostBytes, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  auto trial = ReadTrial(text);
  if (trial && trial->stem != path.stem().string()) return std::nullopt;
  return trial;
}

}  // namespace

TrialBook::TrialBook(const Folder& folder) : folder_(folder) {
  constexpr std::size_t kMostFiles = 20 * kMost;
  for (const FileEntry& file : folder.List(kMostFiles)) {
    const std::filesystem::path path = folder.path() / file.name;
    if (path.extension() != ".json" || file.bytes > kMostBytes) continue;
    if (auto trial = ReadTrialFile(path)) trials_.push_back(*std::move(trial));
    if (trials_.size() == kMost) break;
  }
  std::stable_sort(trials_.begin(), trials_.end(), [](const Trial& a, const Trial& b) {
    return a.started_micros < b.started_micros;
  });
}

std::string TrialBook::Put(const Trial& trial) {
  try {
    render::WriteNewFile(folder_.path() / (trial.stem + ".json"), TrialText(trial));
  } catch (const std::exception& error) {
    return error.what();
  }
  const auto known = std::find_if(trials_.begin(), trials_.end(),
                                  [&](const Trial& other) { return other.stem == trial.stem; });
  if (known != trials_.end()) {
    *known = trial;
  } else {
    trials_.push_back(trial);
  }
  return "";
}

const Trial* TrialBook::Find(const std::string& stem) const {
  const auto known = std::find_if(trials_.begin(), trials_.end(),
                                  [&](const Trial& trial) { return trial.stem == stem; });
  return known == trials_.end() ? nullptr : &*known;
}

}  // namespace kinescope::recording
