/// Carries out what ROS orders of a running server: a snapshot, a recording, other settings.
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>

#include "core/scene_state.h"
#include "core/system/latest.h"
#include "server/app/serve/change_mailbox.h"
#include "server/app/serve/control_desk.h"
#include "server/app/serve/live_pictures.h"
#include "server/http/server.h"
#include "server/recording/folder.h"
#include "server/ros/bridge.h"

namespace kinescope::app {

class RosDesk {
 public:
  /// All are borrowed, until Close(). Without a page, settings of the person and the limits alone.
  struct Parts {
    const Latest<SceneState>& states;
    std::shared_ptr<const PersonModel> initial_model;  // until the first person comes
    ChangeMailbox& changes;
    LivePictures* pictures = nullptr;  // null: pictures are off
    http::HttpServer* page = nullptr;  // null: so is the desk
    ControlDesk* desk = nullptr;
    const recording::Folder& folder;
  };

  /// Orders are refused before Open() and after Close(), which ends one that is carried out.
  void Open(const Parts& parts);
  void Close();

  /// A picture of the newest sample, by the camera of the live picture, in the folder of
  /// recordings. @return its path. Any thread; waits for the picture.
  ros_bridge::RosAnswer Snapshot();
  /// Starts or stops a recording. @return its file. Any thread; waits for the page's thread.
  ros_bridge::RosAnswer Record(bool run);

  /// Of the newest sample; nullopt before Open() and after Close(). Any thread; waits for the
  /// page's thread.
  std::optional<ros_bridge::LiveSettings> Settings();
  /// Changes what can be changed. Any thread; waits for the page's thread.
  ros_bridge::RosAnswer Change(const ros_bridge::SettingsChange& wanted);

 private:
  template <class Result>
  std::optional<Result> Await(std::future<Result>& result) const;
  /// What `work` returns on the page's thread; nullopt: the server ends.
  template <class Result>
  std::optional<Result> OnPage(std::function<Result()> work) const;

  std::atomic<bool> is_closing_{false};
  std::mutex mutex_;  // held while an order is carried out
  // Guarded by mutex_:
  std::optional<Parts> parts_;
  std::shared_ptr<const PersonModel> first_model_;  // of the first person when last seen
};

}  // namespace kinescope::app
