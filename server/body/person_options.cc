#include "server/body/person_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "server/body/body_color.h"
#include "server/body/model_name.h"
#include "server/options/ros_names.h"

namespace kinescope::app {
namespace {

using options::BadValue;
using options::Choice;
using options::Number;
using Frame = urdf::MeshConvention::Frame;

constexpr char kOwnMeshes[] = "mesh:";

urdf::AddedMass ToAddedMass(const std::string& item) try {
  return urdf::ParseAddedMass(item);
} catch (const std::invalid_argument& error) {
  throw BadValue(error.what());
}

std::vector<std::string> SegmentNames() {
  std::vector<std::string> names;
  names.reserve(urdf::kSegments.size());
  for (const urdf::SegmentInfo& segment : urdf::kSegments) names.emplace_back(segment.link_name);
  return names;
}

}  // namespace

void BodyModelValue::Parse(const std::string& text) {
  const std::string own = kOwnMeshes;
  if (text == "smooth" || text == "primitive") {
    value_ = {text == "smooth", ""};
  } else if (StartsWith(text, own) && text.size() > own.size()) {
    value_ = {true, text.substr(own.size())};
  } else {
    RefuseText();
  }
}

std::string BodyModelValue::ToText() const {
  if (!value_.folder.empty()) return kOwnMeshes + value_.folder;
  return value_.is_smooth ? "smooth" : "primitive";
}

std::vector<std::filesystem::path> BodyModelValue::Files() const {
  return value_.folder.empty() ? std::vector<std::filesystem::path>()
                               : FilesOfCustomBody(value_.folder);
}

void BodyModelValue::SetFolder(const std::filesystem::path& folder) {
  if (!value_.folder.empty()) value_.folder = (folder / value_.folder).string();
}

void BodyColorValue::Parse(const std::string& text) {
  value_ = ColorFromHex(text);
  if (!value_ && text != "suit") RefuseText();
}

PersonOptions::PersonOptions()
    : model_name("skeleton", "letters, digits and _", IsModelName),
      tf_topic("", kTopicNameExpected, IsTopicNameOrEmpty),
      sex(Choice<urdf::Sex>({{"male", urdf::Sex::kMale}, {"female", urdf::Sex::kFemale}},
                            urdf::Sex::kMale)),
      mass(Number(urdf::DefaultMass(urdf::Sex::kMale), {20, 300, "kg"})),
      height(Number(urdf::kDefaultHeight, {0.5, 2.5, "m"})),
      body_table({{"de_leva", urdf::BodyTable::kDeLeva},
                  {"winter", urdf::BodyTable::kWinter},
                  {"dumas", urdf::BodyTable::kDumas},
                  {"iit", urdf::BodyTable::kIit}},
                 urdf::BodyDescription().table),
      extra_mass(fmt::format(
                     "SEGMENT:KG or SEGMENT:KG@X,Y,Z (m, in the frame of the segment's link), with "
                     "commas between several, such as head:1.5,t8:8@-0.15,0,0.1; segments: {}",
                     fmt::join(SegmentNames(), ", ")),
                 urdf::kMaxAddedMasses, ToAddedMass, {}, SegmentNames()),
      mesh_units({{"m", 1}, {"cm", 0.01}, {"mm", 0.001}}, 1),
      mesh_up({{"z", false}, {"y", true}}, false),
      mesh_scale({{"fit", true}, {"none", false}}, true),
      mesh_frame({{"auto", Frame::kLonger}, {"segment", Frame::kSegment}, {"link", Frame::kLink}},
                 Frame::kLonger) {}

void PersonOptions::List(options::OptionList& option) {
  option.Group("The person");
  option("model_name", model_name, "prefix of links, joints and TF frames");
  option("tf_topic", tf_topic, kTfTopicHelp);
  option("sex", sex, "selects body table and strength; not given: male is assumed");
  option("mass", mass,
         fmt::format("body mass; not given: {} kg (male) or {} kg (female) is assumed",
                     urdf::DefaultMass(urdf::Sex::kMale), urdf::DefaultMass(urdf::Sex::kFemale)));
  option("height", height,
         fmt::format(
             "stature until the stream contains segment lengths, and that of demo: and pose:; not "
             "given: {} m is "
             "assumed",
             urdf::kDefaultHeight));
  option("body_table", body_table, "source of the segment masses (docs/loads.md)");
  option("extra_mass", extra_mass, "equipment that is worn or carried");
  option(
      "body_model", body_model,
      "surface of the body; a FOLDER has STL, DAE, OBJ or GLB files named after segments, such as "
      "RightForeArm.stl");
  option("body_color", body_color,
         fmt::format("colour of the suit, at least {} (CIEDE2000) from the colour of each load "
                     "class; suit: quiet greys, and bands in the colour that the suit sends",
                     kMinContrast));
  option("tool", tool,
         "mesh (STL, DAE, OBJ or GLB) of a held tool, its origin at the grip unless placed; "
         "--hand_load sets its mass");
  option("mesh_units", mesh_units, "unit of custom STL and OBJ meshes");
  option("mesh_up", mesh_up, "up axis of custom STL and OBJ meshes");
  option("mesh_scale", mesh_scale,
         "whether custom meshes are stretched along their segments to the person's lengths");
  option(
      "mesh_frame", mesh_frame,
      "arm meshes point: segment (along y, as in the T-pose), link (along -z, as in the N-pose), "
      "auto (whichever of the two is the longer side of the mesh)");
}

std::optional<Rgb> ToBodyColor(const PersonOptions& person) {
  const std::optional<Rgb>& color = *person.body_color;
  const auto near = color ? FindNearClass(*color) : std::nullopt;
  if (!near) return color;
  throw UsageError(
      fmt::format("--body_color={}: looks like the colour of the load class {} (CIEDE2000 {:.1f}, "
                  "at least {} expected); the most similar colour that does not: {}",
                  person.body_color.ToText(), Name(near->load_class), near->difference,
                  kMinContrast, ToHex(NearestSafeColor(*color))));
}

BodyAppearance ToAppearance(const PersonOptions& person) {
  urdf::MeshConvention convention;
  convention.metres_per_unit = *person.mesh_units;
  convention.y_is_up = *person.mesh_up;
  convention.fits_person = *person.mesh_scale;
  convention.frame = *person.mesh_frame;
  BodyAppearance appearance;
  appearance.is_smooth = person.body_model->is_smooth;
  if (!person.body_model->folder.empty()) {
    appearance.custom = ReadCustomBodyMeshes(person.body_model->folder, convention);
  }
  appearance.tools = ReadHandTools(person.tool, convention);
  return appearance;
}

urdf::BodyDescription ToBody(const PersonOptions& person) {
  urdf::BodyDescription body;
  body.sex_is_assumed = !person.sex;
  body.sex = person.sex.value_or(urdf::Sex::kMale);
  body.mass_is_assumed = !person.mass;
  body.mass_kg = person.mass.value_or(urdf::DefaultMass(body.sex));
  body.table = *person.body_table;
  body.added_masses = *person.extra_mass;
  if (const auto defect = urdf::FindDefect(body); !defect.empty()) {
    throw UsageError(fmt::format("--extra_mass={}: {}", person.extra_mass.ToText(), defect));
  }
  return body;
}

}  // namespace kinescope::app
