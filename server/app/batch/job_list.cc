#include "server/app/batch/job_list.h"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <unordered_map>
#include <utility>

#include "core/system/errors.h"
#include "core/system/input_file.h"
#include "core/system/utf8.h"
#include "server/app/batch/job_command.h"
#include "server/app/batch/json_lines.h"
#include "server/app/render/draw_pools.h"
#include "server/table/output_file.h"

namespace kinescope::app {
namespace {

class ListReader {
 public:
  explicit ListReader(const std::string& path) { list_.path = path; }

  void Take(int number, const std::string& line) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) return;
    try {
      Job job = ReadJob(line);
      job.line = number;
      Add(std::move(job));
    } catch (const UsageError& error) {
      AddFault(number, error.what());
    }
  }
  void AddFault(int number, const std::string& reason) {
    list_.faults.push_back(fmt::format("{}:{}: {}", list_.path, number, reason));
  }
  JobList list() { return std::move(list_); }

 private:
  void Add(Job job) {
    const auto [first, is_new] = lines_.emplace(job.id, job.line);
    if (!is_new) {
      throw UsageError(fmt::format("id '{}' is already that of line {}; give each job its own",
                                   job.id, first->second));
    }
    if (list_.jobs.size() == kMostJobs) {
      throw SourceError(
          fmt::format("{}: more than {} jobs; split the list", list_.path, kMostJobs));
    }
    list_.jobs.push_back(std::move(job));
  }

  JobList list_;
  std::unordered_map<std::string, int> lines_;  // by id
};

}  // namespace

std::string JobList::PlaceOf(const Job& job) const { return fmt::format("{}:{}", path, job.line); }

JobList ReadJobList(const std::string& path) {
  ListReader reader(path);
  InputFile file = OpenInputFile(path);
  JsonLines lines(file, kMostJobBytes);
  while (const auto line = lines.Next()) {
    if (line->is_too_long) {
      reader.AddFault(line->number, fmt::format("longer than {} bytes", kMostJobBytes));
    } else {
      reader.Take(line->number, line->text);
    }
  }
  if (!lines.failure().empty()) throw SourceError(path + ": " + lines.failure());
  return reader.list();
}

std::vector<std::string> RefusalsOf(const JobList& list) {
  const auto pools = std::make_shared<DrawPools>();
  std::vector<std::string> refusals(list.jobs.size());
  std::unordered_map<std::string, std::size_t> writers;  // by the place of the file
  for (std::size_t i = 0; i < list.jobs.size(); ++i) {
    const Job& job = list.jobs[i];
    try {
      for (const DeclaredOutput& output : OutputsOf(CommandOf(job, pools))) {
        const auto [first, is_new] = writers.emplace(PlaceOfOutput(output.path), i);
        if (is_new || first->second == i) continue;
        const Job& other = list.jobs[first->second];
        throw UsageError(
            fmt::format("{}={}: is also written by job '{}' in line {}; give each "
                        "job its own output",
                        output.option, output.path, other.id, other.line));
      }
    } catch (const std::exception& error) {
      refusals[i] = error.what();
    }
  }
  return refusals;
}

}  // namespace kinescope::app
