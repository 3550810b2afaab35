#include "server/app/render/draw_pools.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <mutex>
#include <set>

#include "server/picture/cores.h"

namespace kinescope::app {
namespace {

// Each renderer says once what is wrong with a mesh; all of them together, too.
render::LogLine LogOnce() {
  struct Said {
    std::mutex mutex;
    std::set<std::string> lines;  // guarded by mutex
  };
  return [said = std::make_shared<Said>()](const std::string& line) {
    const std::lock_guard lock(said->mutex);
    if (said->lines.insert(line).second) spdlog::warn("{}", line);
  };
}

std::unique_ptr<DrawPool> MakeDrawPool(int jobs, std::size_t most_pictures,
                                       const BackendOptions& backend) {
  render::UseFillingThreads(FillingThreads(CoresHere(), jobs));
  const BackendChoice choice = ChooseBackend(backend);
  if (!choice.note.empty()) spdlog::warn("pictures: {}", choice.note);
  return std::make_unique<DrawPool>(jobs, most_pictures, [backend, choice, log = LogOnce()] {
    return StartRenderer(backend, choice, {}, log);
  });
}

}  // namespace

DrawPool& DrawPools::PoolFor(int jobs, const render::PictureSpec& spec,
                             const BackendOptions& backend) {
  const std::size_t most_pictures = MostPictures(jobs, spec.width, spec.height);
  std::string wanted =
      fmt::format("{} {} {}", jobs, backend.backend.ToText(), backend.draw_limit_secs.ToText());
  if (pool_ != nullptr && wanted == made_for_) {
    pool_->SetMostPictures(most_pictures);
    return *pool_;
  }
  pool_.reset();  // a process has room for one
  pool_ = MakeDrawPool(jobs, most_pictures, backend);
  made_for_ = std::move(wanted);
  return *pool_;
}

}  // namespace kinescope::app
