#include "server/app/render/draw_pools.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "server/picture/cores.h"

namespace kinescope::app {
namespace {

std::unique_ptr<DrawPool> MakeDrawPool(int jobs, std::size_t most_pictures,
                                       const BackendOptions& backend) {
  render::UseFillingThreads(FillingThreads(CoresHere(), jobs));
  const BackendChoice choice = ChooseBackend(backend);
  if (!choice.note.empty()) spdlog::warn("pictures: {}", choice.note);
  return std::make_unique<DrawPool>(jobs, most_pictures,
                                    [backend, choice] { return StartRenderer(backend, choice); });
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
