#include "server/app/golden/golden_suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <system_error>

#include "core/system/errors.h"
#include "core/system/words.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

constexpr char kCase[] = ".yaml", kAlmostCase[] = ".yml", kPicture[] = ".png";
constexpr char kObjects[] = ".objects.json";  // of earlier versions

// "bend" of "bend.objects.json"; nullopt if the name has another ending.
std::optional<std::string> NameBefore(const std::string& ending, const fs::path& file) {
  const std::string name = file.filename();
  if (name.size() <= ending.size()) return std::nullopt;
  const std::size_t at = name.size() - ending.size();
  if (name.compare(at, ending.size(), ending) != 0) return std::nullopt;
  return name.substr(0, at);
}

// Its pictures have longer names, which file systems limit, and commands must be able to name it.
void CheckCaseFile(const fs::path& yaml) {
  constexpr std::size_t kMostName = 200;  // bytes
  const std::string name = yaml.stem();
  if (name.size() > kMostName) {
    throw std::runtime_error(fmt::format("{}: its name has {} bytes; a case may have {}; rename it",
                                         yaml.string(), name.size(), kMostName));
  }
  if (name.front() == '-') {
    throw std::runtime_error(yaml.string() +
                             ": a name that begins with '-' is taken for an option; rename it");
  }
  if (!fs::is_regular_file(yaml)) throw std::runtime_error(yaml.string() + ": is no file");
}

FoundCase Read(const fs::path& yaml) {
  FoundCase found;
  found.name = yaml.stem();
  try {
    CheckCaseFile(yaml);
    found.read = LoadGoldenCase(yaml);
  } catch (const std::exception& error) {
    found.error = error.what();
  }
  return found;
}

// On some computers both have the same picture.
void RefuseTwinsOf(FoundCase& found, const std::set<std::string>& known, const fs::path& folder) {
  for (const std::string& other : known) {
    if (other == found.name || Lower(other) != Lower(found.name)) continue;
    found.read.reset();
    found.error = fmt::format("{}: only upper and lower case tell it from {}; rename one of them",
                              (folder / (found.name + kCase)).string(), other + kCase);
  }
}

std::string NotThere(const fs::path& folder, const std::string& name,
                     const std::set<std::string>& known) {
  const std::string suggestion =
      SuggestionFor(name, std::vector<std::string>(known.begin(), known.end()));
  return fmt::format("folder '{}' contains no golden case '{}'{}", folder.string(), name,
                     suggestion.empty() ? "; write " + name + kCase + " there" : suggestion);
}

}  // namespace

fs::path GoldenSuite::PictureOf(const std::string& picture) const {
  return folder / pictures / (picture + kPicture);
}

fs::path GoldenSuite::CaseFileOf(const FoundCase& found) const {
  return folder / (found.name + kCase);
}

fs::path GoldenSuite::lock_file() const { return folder / "golden.lock"; }

void GoldenSuite::WriteLockFile() const { WriteLock(lock_file(), lock, pictures); }

const AcceptedCase* GoldenSuite::AcceptedOf(const std::string& picture) const {
  const auto accepted = lock.find(picture);
  return accepted == lock.end() ? nullptr : &accepted->second;
}

std::vector<std::string> GoldenSuite::AcceptedPicturesOf(const FoundCase& found) const {
  std::vector<std::string> names;
  for (const auto& [name, ignored] : lock) {
    if (CaseNameOf(name) == found.name) names.push_back(name);
  }
  return names;
}

GoldenSuite FindGoldenSuite(const fs::path& folder, const std::vector<std::string>& names) {
  std::set<std::string> known;
  std::vector<fs::path> accepted, unread;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (const auto name = NameBefore(kCase, entry.path())) known.insert(*name);
    const bool is_nameless = entry.path().filename() == kCase;
    if (is_nameless || NameBefore(kAlmostCase, entry.path()))
      unread.push_back(entry.path().filename());
    if (NameBefore(kPicture, entry.path()) || NameBefore(kObjects, entry.path())) {
      accepted.push_back(entry.path().filename());
    }
  }
  if (error) {
    throw UsageError(fmt::format("folder '{}': {}; name the folder that holds the golden cases",
                                 folder.string(), error.message()));
  }
  if (known.empty()) {
    throw UsageError(fmt::format("folder '{}' contains no golden case (*.yaml)", folder.string()));
  }
  GoldenSuite suite;
  suite.folder = folder;
  suite.lock = ReadLock(suite.lock_file(), &suite.pictures);
  if (!suite.pictures.empty()) {
    for (const auto& entry : fs::directory_iterator(folder / suite.pictures, error)) {
      if (!NameBefore(kPicture, entry.path())) continue;
      accepted.push_back(fs::path(suite.pictures) / entry.path().filename());
    }
  }
  std::set<std::string> chosen;
  for (const std::string& name : names) {
    const std::string case_name = CaseNameOf(name);
    if (known.count(case_name) == 0) throw UsageError(NotThere(folder, name, known));
    chosen.insert(case_name);
  }
  if (names.empty()) chosen = known;
  for (const std::string& name : chosen) {
    suite.cases.push_back(Read(folder / (name + kCase)));
    RefuseTwinsOf(suite.cases.back(), known, folder);
  }
  if (!names.empty()) return suite;  // of the others nothing is known
  std::sort(unread.begin(), unread.end());
  suite.unread = std::move(unread);
  for (const auto& [name, ignored] : suite.lock) {
    if (known.count(CaseNameOf(name)) == 0) suite.unknown_locks.push_back(name);
  }
  std::sort(accepted.begin(), accepted.end());
  for (fs::path& file : accepted) {
    const auto name = NameBefore(kPicture, file);
    const bool is_where_pictures_are = file.parent_path() == fs::path(suite.pictures);
    const bool has_case = name && is_where_pictures_are && known.count(CaseNameOf(*name)) > 0 &&
                          (CaseNameOf(*name) == *name || suite.lock.count(*name) > 0);
    if (!has_case) suite.orphans.push_back(std::move(file));
  }
  return suite;
}

GoldenSuite ShareOf(GoldenSuite suite, const Shard& shard) {
  const auto keep = [&](auto& all, const auto& name_of) {
    const auto is_of_others = [&](const auto& each) { return !shard.Has(name_of(each)); };
    all.erase(std::remove_if(all.begin(), all.end(), is_of_others), all.end());
  };
  keep(suite.cases, [](const FoundCase& found) { return found.name; });
  for (std::vector<fs::path>* files : {&suite.orphans, &suite.unread}) {
    keep(*files, [](const fs::path& file) { return file.string(); });
  }
  keep(suite.unknown_locks, [](const std::string& name) { return name; });
  return suite;
}

}  // namespace kinescope::app
