#include "server/app/serve/ros_desk.h"

#include <chrono>
#include <exception>
#include <filesystem>
#include <future>
#include <memory>

#include "render/image/png_file.h"
#include "server/app/serve/operator_log.h"
#include "server/http/answer.h"

namespace kinescope::app {
namespace {

using ros_bridge::RosAnswer;

constexpr std::chrono::milliseconds kLook(50);  // for the end of the server
constexpr char kNotNow[] = "the server is starting or stopping";

}  // namespace

void RosDesk::Open(const Parts& parts) {
  const std::lock_guard<std::mutex> lock(mutex_);
  parts_.emplace(parts);
}

void RosDesk::Close() {
  is_closing_ = true;
  const std::lock_guard<std::mutex> lock(mutex_);
  parts_.reset();
}

// nullopt: the server ends.
template <class Result>
std::optional<Result> RosDesk::Await(std::future<Result>& result) const {
  while (result.wait_for(kLook) != std::future_status::ready) {
    if (is_closing_) return std::nullopt;
  }
  return result.get();
}

RosAnswer RosDesk::Snapshot() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!parts_) return {false, kNotNow};
  if (parts_->pictures == nullptr) return {false, http::kNoRenderer};
  const recording::Folder& folder = parts_->folder;
  if (const std::string wrong = folder.Prepare(); !wrong.empty()) return {false, wrong};
  try {
    auto picture = parts_->pictures->Order({});
    const auto image = Await(picture);
    if (!image) return {false, kNotNow};
    const std::string stem = folder.FreeStem("snapshot_" + recording::TimeName());
    const auto file = std::filesystem::absolute(folder.path() / (stem + ".png"));
    render::WritePng(file, *image);
    return {true, file.string()};
  } catch (const std::exception& error) {
    return {false, error.what()};
  }
}

RosAnswer RosDesk::Record(bool run) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!parts_) return {false, kNotNow};
  const auto promise = std::make_shared<std::promise<ControlDesk::Recorded>>();
  auto recorded = promise->get_future();
  parts_->page.Post([promise, run, desk = &parts_->desk] {
    promise->set_value(desk->Record({run, ""}, kRosRole));
  });
  const auto file = Await(recorded);
  if (!file) return {false, kNotNow};
  if (!*file) return {false, file->error().reason};
  return {true, std::filesystem::absolute(parts_->folder.path() / **file).string()};
}

}  // namespace kinescope::app
