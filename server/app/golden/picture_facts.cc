#include "server/app/golden/picture_facts.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "core/system/json_text.h"
#include "server/app/ordered_json.h"

namespace kinescope::app {
namespace {

using nlohmann::json;

constexpr std::int64_t kMostPixels = std::int64_t{1} << 40;

std::string InView(const std::string& view, const std::string& name) {
  return view.empty() ? name : view + "/" + name;
}

// "right_elbow", and whose where it is not the first person's.
std::string NameOf(const std::string& name, int character) {
  return character <= 0 ? name : fmt::format("{} of person {}", name, character);
}

std::optional<LoadClass> ClassFrom(const std::string& name) {
  for (const LoadClass load_class : kLoadClasses) {
    if (name == Name(load_class)) return load_class;
  }
  return std::nullopt;
}

Json ToJson(const ObjectFact& object) {
  Json line = {{"name", object.name}};
  if (object.load_class) line["class"] = Name(*object.load_class);
  if (object.ratio) line["ratio"] = Rounded(*object.ratio, 1000);
  line["pixels"] = object.pixels;
  if (object.through > 0) line["through"] = object.through;
  line["x"] = Rounded(object.x_px, 10);
  line["y"] = Rounded(object.y_px, 10);
  return line;
}

Json ToJson(const TextFact& text) {
  return {{"part", text.part},
          {"text", text.text},
          {"x", Rounded(text.x_px, 10)},
          {"y", Rounded(text.y_px, 10)}};
}

Json XyzJson(const Eigen::Vector3d& metres) {
  return {Rounded(metres.x(), 1e4), Rounded(metres.y(), 1e4), Rounded(metres.z(), 1e4)};
}

Json ToJson(const CameraFact& fact) {
  const render::Camera& camera = fact.camera;
  return {{"view", fact.view},
          {"position_m", XyzJson(camera.position)},
          {"target_m", XyzJson(camera.target)},
          {"up", XyzJson(camera.up)},
          {"vertical_fov_rad", Rounded(camera.vertical_fov_rad, 1e6)},
          {"ortho_height_m", Rounded(camera.ortho_height_m, 1e4)}};
}

template <class Fact>
std::string Lines(const char* name, const std::vector<Fact>& facts) {
  std::string lines = fmt::format("\"{}\": [", name);
  const char* separator = "\n  ";
  for (const Fact& fact : facts) {
    lines += separator + JsonText(ToJson(fact));
    separator = ",\n  ";
  }
  return lines + (facts.empty() ? "]" : "\n ]");
}

// By joint: w, x, y, z.
Json TurnsOf(const std::vector<JointFact>& joints) {
  Json turns = Json::object();
  for (const JointFact& joint : joints) {
    for (const double part : joint.parent_from_child) {
      turns[joint.name].push_back(Rounded(part, 1e4));
    }
  }
  return turns;
}

JointFact JointFrom(const std::string& name, const json& turn) {
  JointFact joint = {name};
  double squared = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    joint.parent_from_child[i] = turn.at(i).get<double>();
    squared += joint.parent_from_child[i] * joint.parent_from_child[i];
  }
  if (std::abs(squared - 1) < 0.01) return joint;
  throw json::other_error::create(
      501, fmt::format("{}: expected a rotation, such as [1,0,0,0]", JsonText(turn)), &turn);
}

Eigen::Vector3d PlaceFrom(const json& place) {
  return {place.at(0).get<double>(), place.at(1).get<double>(), place.at(2).get<double>()};
}

ObjectFact ObjectFrom(const json& line) {
  ObjectFact object;
  object.name = line.at("name");
  object.load_class = ClassFrom(line.value("class", ""));
  if (line.contains("ratio")) object.ratio = line.at("ratio").get<double>();
  object.pixels = CountFrom(line.at("pixels"), kMostPixels);
  if (line.contains("through")) object.through = CountFrom(line.at("through"), kMostPixels);
  object.x_px = line.at("x");
  object.y_px = line.at("y");
  return object;
}

CameraFact CameraFrom(const json& line) {
  CameraFact fact;
  fact.view = line.at("view");
  fact.camera.position = PlaceFrom(line.at("position_m"));
  fact.camera.target = PlaceFrom(line.at("target_m"));
  fact.camera.up = PlaceFrom(line.at("up"));
  fact.camera.vertical_fov_rad = line.at("vertical_fov_rad");
  fact.camera.ortho_height_m = line.at("ortho_height_m");
  return fact;
}

}  // namespace

std::vector<ObjectFact> ObjectFactsOf(const render::PictureContents& contents,
                                      const std::vector<render::SphereInPicture>& loads) {
  std::map<std::string, const render::SphereInPicture*> by_name;
  for (const render::SphereInPicture& load : loads) {
    by_name[NameOf(load.joint, load.character)] = &load;
  }
  std::vector<ObjectFact> facts;
  for (const render::SeenObject& seen : contents.objects) {
    ObjectFact fact;
    fact.name = NameOf(InView(seen.view, seen.name), seen.character);
    fact.pixels = seen.pixels;
    fact.through = seen.through;
    fact.x_px = seen.x_px;
    fact.y_px = seen.y_px;
    if (const auto load = by_name.find(fact.name); load != by_name.end()) {
      fact.load_class = load->second->load_class;
      if (std::isfinite(load->second->ratio)) fact.ratio = load->second->ratio;
    }
    facts.push_back(std::move(fact));
  }
  return facts;
}

std::vector<ObjectPlace> ObjectPlacesOf(const render::PictureContents& contents) {
  std::vector<ObjectPlace> places;
  for (const render::SeenObject& seen : contents.objects) {
    places.push_back({NameOf(InView(seen.view, seen.name), seen.character), seen.box});
  }
  return places;
}

std::vector<std::string> ObjectsIn(const render::Tile& box, std::vector<ObjectPlace> places) {
  constexpr std::size_t kMostNames = 3;
  const auto area = [](const ObjectPlace& place) {
    return std::int64_t{place.box.width} * place.box.height;
  };
  std::stable_sort(places.begin(), places.end(),
                   [&](const ObjectPlace& a, const ObjectPlace& b) { return area(a) < area(b); });
  std::vector<std::string> names;
  for (const ObjectPlace& place : places) {
    if (names.size() == kMostNames) break;
    if (!render::IsEmpty(render::Intersection(place.box, box))) names.push_back(place.name);
  }
  return names;
}

std::vector<JointFact> JointFactsOf(const std::vector<JointTurn>& turns) {
  std::vector<JointFact> facts;
  facts.reserve(turns.size());
  for (const JointTurn& turn : turns) {
    facts.push_back({NameOf(turn.joint, turn.character), turn.parent_from_child});
  }
  return facts;
}

std::vector<TextFact> TextFactsOf(const render::PictureContents& contents) {
  std::vector<TextFact> facts;
  for (const render::PaintedText& text : contents.texts) {
    facts.push_back({text.part, text.text, text.x_px, text.y_px});
  }
  return facts;
}

std::int64_t CountFrom(const json& value, std::int64_t most) {
  const bool is_whole = value.is_number_integer();
  const auto count = is_whole ? value.get<std::int64_t>() : -1;
  if (count >= 0 && count <= most) return count;
  throw json::other_error::create(
      501, fmt::format("{}: expected a whole number from 0 to {}", JsonText(value), most), &value);
}

std::string ToJson(const PictureFacts& facts) {
  const std::string level =
      facts.floor_z_m ? fmt::format(" \"floor_z_m\": {:.4f},", *facts.floor_z_m) : "";
  const std::string joints =
      facts.joints.empty() ? "" : " \"joints\": " + JsonText(TurnsOf(facts.joints)) + ",\n";
  return fmt::format("\"floor\": {},{}\n {},\n {},\n{} {}", facts.has_floor, level,
                     Lines("cameras", facts.cameras), Lines("objects", facts.objects), joints,
                     Lines("texts", facts.texts));
}

PictureFacts FactsFrom(const json& json) {
  PictureFacts facts;
  facts.has_floor = json.at("floor");
  if (json.contains("floor_z_m")) facts.floor_z_m = json.at("floor_z_m").get<double>();
  for (const auto& line : json.at("cameras")) facts.cameras.push_back(CameraFrom(line));
  for (const auto& line : json.at("objects")) facts.objects.push_back(ObjectFrom(line));
  if (json.contains("joints")) {
    for (const auto& [name, turn] : json.at("joints").items()) {
      facts.joints.push_back(JointFrom(name, turn));
    }
  }
  for (const auto& line : json.at("texts")) {
    facts.texts.push_back({line.at("part"), line.at("text"), line.at("x"), line.at("y")});
  }
  return facts;
}

}  // namespace kinescope::app
