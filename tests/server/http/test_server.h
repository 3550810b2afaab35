/// A server on a free port, with a feed that a test can hold up and look into.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "server/http/server.h"
#include "tests/folders.h"
#include "tests/server/http/test_client.h"
#include "tests/server/http/test_scene.h"

namespace kinescope::http::testing {

class FakeFeed final : public PictureFeed {
 public:
  void SetViewers(int count) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    viewers_ = count;
    changed_.notify_all();
  }
  bool SetCamera(const std::string& camera) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (camera != "front" && camera != "iso") return false;
    camera_ = camera;
    return true;
  }
  void SetDark(bool is_dark) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_dark_ = is_dark;
  }
  std::vector<std::uint8_t> SnapshotPng(const SnapshotRequest& request) override {
    const auto& [camera, width, height, is_dark, state] = request;
    std::unique_lock<std::mutex> lock(mutex_);
    ++drawing_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return !held_; });
    if (camera == "iso") throw UsageError("iso is out of order");
    if (camera == "back") throw std::runtime_error("the driver failed");
    const std::string text = camera + " " + std::to_string(width) + "x" + std::to_string(height) +
                             (is_dark ? " dark" : "") +
                             (state ? " state " + std::to_string(state->number) : "");
    return {text.begin(), text.end()};
  }

  void Hold(bool held) {
    const std::lock_guard<std::mutex> lock(mutex_);
    held_ = held;
    changed_.notify_all();
  }
  bool WaitUntilDrawing() {
    return Wait([this] { return drawing_ > 0; });
  }
  bool WaitForViewers(int count) {
    return Wait([this, count] { return viewers_ == count; });
  }
  bool is_dark() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return is_dark_;
  }
  std::string camera() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return camera_;
  }
  int drawn() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return drawing_;
  }

 private:
  bool Wait(const std::function<bool()>& condition) {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(10), condition);
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  int viewers_ = -1;
  int drawing_ = 0;
  bool held_ = false;
  bool is_dark_ = false;
  std::string camera_;
};

struct TestServer {
  explicit TestServer(const std::string& token = "", bool with_feed = true,
                      const std::string& mesh_folder = "", const PatienceLimits& limits = {},
                      const std::function<void(HttpConfig&)>& change = nullptr)
      : patience(limits),
        model(MakePersonModel(7, mesh_folder)),
        server(ConfigWithLoads(token, change), states, pictures, with_feed ? &feed : nullptr,
               [] { return std::string(R"({"source": {"datagrams": 5}})"); }) {}

  static HttpConfig MakeConfig(const std::string& token) {
    HttpConfig config;
    config.port = 0;
    config.token = token;
    config.web_root = kinescope::testing::InSourceTree("web");
    config.cameras = MakeCameras();
    config.framing = MakeFraming();
    config.camera = "front";
    return config;
  }

  HttpConfig ConfigWithLoads(const std::string& token,
                             const std::function<void(HttpConfig&)>& change) {
    HttpConfig config = MakeConfig(token);
    if (!token.empty()) config.viewer_token = kViewerToken;
    config.patience = patience;
    config.history = &history;
    config.set_hand_load = [this](int character, const HandLoad& load) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (load.mass_kg[urdf::kRight] > 100) return std::string("nobody holds that");
      told[character] = load;
      return std::string();
    };
    if (change) change(config);
    return config;
  }
  std::map<int, HandLoad> Told() {
    const std::lock_guard<std::mutex> lock(mutex);
    return told;
  }

  void PublishState(std::uint64_t number,
                    const std::function<void(SceneState& state)>& change = nullptr) {
    auto state = std::make_shared<SceneState>(
        MakeScene(number, static_cast<double>(number) / 60, MonotonicNanos(), model));
    state->made_nanos = state->arrival_nanos;
    if (change) change(*state);
    states.Publish(state);
    history.Add(std::move(state));
  }
  void PublishPicture(std::uint64_t number, std::size_t size) {
    Picture picture;
    picture.jpeg.assign(size, 0xAB);
    picture.state_number = number;
    pictures.Publish(std::make_shared<const Picture>(std::move(picture)));
  }
  Response Get(const std::string& target, const Headers& headers = {}) const {
    return Fetch(server.port(), target, headers);
  }
  nlohmann::json HttpCounters() const { return Get("/api/v1/diagnostics").json()["http"]; }

  const PatienceLimits patience;
  std::mutex mutex;
  std::map<int, HandLoad> told;  // guarded by mutex
  FakeFeed feed;
  Latest<SceneState> states;
  Latest<Picture> pictures;
  history::History history;
  std::shared_ptr<const PersonModel> model;
  HttpServer server;
};

}  // namespace kinescope::http::testing
