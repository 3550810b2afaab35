/// Carries out what ROS orders of a running server: a snapshot, and a recording.
#pragma once

#include <atomic>
#include <future>
#include <mutex>
#include <optional>

#include "server/app/serve/control_desk.h"
#include "server/app/serve/live_pictures.h"
#include "server/http/server.h"
#include "server/recording/folder.h"
#include "server/ros/bridge.h"

namespace kinescope::app {

class RosDesk {
 public:
  /// All are borrowed, until Close().
  struct Parts {
    LivePictures* pictures = nullptr;  // null: pictures are off
    http::HttpServer& page;
    ControlDesk& desk;
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

 private:
  template <class Result>
  std::optional<Result> Await(std::future<Result>& result) const;

  std::atomic<bool> is_closing_{false};
  std::mutex mutex_;            // held while an order is carried out
  std::optional<Parts> parts_;  // guarded by mutex_
};

}  // namespace kinescope::app
