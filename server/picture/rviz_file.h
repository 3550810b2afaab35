/// Reads a configuration of RViz 1 (`.rviz`) as options of ours: camera, background, floor and the
/// parts of people. docs/rviz_files.md
#pragma once

#include <string>
#include <vector>

namespace kinescope::app {

struct RvizPicture {
  std::string fixed_frame;  // without a slash before it
  int fixed_frame_line = 1;
  /// An option, as if it stood in a file of options.
  struct Setting {
    std::string option, text;
    int line = 1;  // of the file
  };
  std::vector<Setting> settings;  // each option at most once
  /// The frame that the view goes with, as --camera_tf has it; its line.
  struct Target {
    std::string frame;  // without a slash before it; "": the fixed frame
    std::string turn;   // "", ":heading" or ":pose"
    int line = 1;
  } target;
  /// Of a display that is on and of a kind that can be shown from its topic.
  struct Topic {
    std::string name;           // as it was saved, such as "/goal"
    std::string style;          // as --marker_topics has it, such as "(color=#ff8800)", or ""
    std::string display;        // "rviz/Pose 'Goal'"
    bool is_of_people = false;  // markers of Kinescope, which the scene has anyway
    int line = 1;
    bool is_every_frame = false;  // no topic: all frames of TF
    bool is_floor = false;        // no topic: a level grid, of which the scene's floor takes the
                                  // place where there are no topics
    bool floor_differs = false;   // which lies elsewhere
  };
  std::vector<Topic> topics;
  /// A model whose description a ROS graph has; also that of a person.
  struct Robot {
    std::string option;   // a value of --robot
    std::string display;  // "rviz/RobotModel 'Arm'"
    int line = 1;
  };
  std::vector<Robot> robots;
  std::vector<std::string>
      remarks;  // "FILE:LINE: what": what RViz draws and we do not, or otherwise
};

/// @param height_px  of the picture: a view from above counts in pixels per metre
/// @throws UsageError "FILE: why" or "FILE:LINE: why": it cannot be read, or is none of RViz 1
RvizPicture ReadRvizFile(const std::string& path, int height_px);
/// `text`: the content of `path`, which is not opened.
RvizPicture ParseRvizFile(const std::string& path, const std::string& text, int height_px);

}  // namespace kinescope::app
