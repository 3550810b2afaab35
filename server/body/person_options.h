/// The person in the suit, as options describe them.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/suit_colors.h"
#include "server/body/body_meshes.h"
#include "server/body/hand_tools.h"
#include "server/options/option_list.h"
#include "urdf/body_parameters.h"
#include "urdf/mesh_fit.h"

namespace kinescope::app {

/// The body's surface.
struct BodyModelSource {
  bool is_smooth = true;  // false: boxes, cylinders and spheres
  std::string folder;     // of custom meshes; "": the built-in body model
};

/// smooth, primitive or mesh:FOLDER.
class BodyModelValue : public options::ValueOf<BodyModelSource> {
 public:
  BodyModelValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override;
  std::string Expected() const override { return "smooth, primitive or mesh:FOLDER"; }
  std::vector<std::string> Names() const override { return {"smooth", "primitive", "mesh:"}; }
  std::vector<std::filesystem::path> Files() const override;
  void SetFolder(const std::filesystem::path& folder) override;
};

/// suit or #RRGGBB.
class BodyColorValue : public options::ValueOf<std::optional<Rgb>> {
 public:
  BodyColorValue() : ValueOf(std::nullopt) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override { return value_ ? ToHex(*value_) : "suit"; }
  std::string Expected() const override { return "suit or #RRGGBB"; }
  std::vector<std::string> Names() const override { return {"suit"}; }
};

struct PersonOptions {
  PersonOptions();

  options::Text model_name, tf_topic;
  options::Optional<options::Choice<urdf::Sex>> sex;
  options::Optional<options::Number> mass, height;  // kg, m
  options::Choice<urdf::BodyTable> body_table;
  options::List<urdf::AddedMass> extra_mass;
  BodyModelValue body_model;
  BodyColorValue body_color;
  ToolsValue tool;
  options::Choice<double> mesh_units;  // m
  options::Choice<bool> mesh_up;       // true: y
  options::Choice<bool> mesh_scale;    // true: fit
  options::Choice<urdf::MeshConvention::Frame> mesh_frame;

  void List(options::OptionList& option);
};

/// @throws UsageError naming option, value and what was expected, where values do not fit together.
urdf::BodyDescription ToBody(const PersonOptions& person);
/// @throws UsageError for a colour that could be mistaken for that of a load class.
std::optional<Rgb> ToBodyColor(const PersonOptions& person);
/// Reads the meshes. @throws UsageError naming the file.
BodyAppearance ToAppearance(const PersonOptions& person);

}  // namespace kinescope::app
