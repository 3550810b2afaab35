/// The option --figure of the commands that draw people.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "render/scene_look.h"
#include "server/options/option_list.h"

namespace kinescope::app {

/// skin, skin:FILE.glb or urdf. As a value, it has no skin of the user's own: Load() reads it.
class FigureValue : public options::ValueOf<render::Figure> {
 public:
  FigureValue() : ValueOf(render::SceneLook().figure) {}
  FigureValue& operator=(render::Figure::Kind kind) {
    value_ = kind;
    file_.clear();
    own_.reset();
    return *this;
  }

  void Parse(const std::string& text) override;
  std::string ToText() const override;
  std::string Expected() const override { return "skin, skin:FILE.glb or urdf"; }
  std::vector<std::string> Names() const override { return {"skin", "skin:", "urdf"}; }
  std::vector<std::filesystem::path> Files() const override;

  /// Before Load().
  void SetFolder(const std::filesystem::path& folder) override;
  /// With the skin of FILE.glb, which is read once for all copies of this value. Any thread.
  /// @throws UsageError with the option, the file and the reason.
  render::Figure Load() const;

 private:
  struct OwnSkin;

  std::string file_;  // "": the built-in skin
  std::shared_ptr<OwnSkin> own_;
};

inline constexpr char kFigureHelp[] =
    "people as one skin; as a rigged person of your own (glTF, VRM; bones named as in VRM, Mixamo "
    "or MVN); or as the rigid parts of the URDF that RViz shows";

}  // namespace kinescope::app
