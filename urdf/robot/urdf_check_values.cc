#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "urdf/robot/robot_model.h"
#include "urdf/robot/urdf_check_parts.h"

namespace kinescope::urdf {
namespace {

using Kind = UrdfProblem::Kind;

constexpr double kMaxMass = 1e6;         // kg, of a link
constexpr double kTriangleSlack = 1e-3;  // of the largest moment: digits that were rounded off
constexpr std::size_t kMaxQuoted = 60;   // characters of a value that are shown

std::string Quoted(const std::string& text) {
  return text.size() <= kMaxQuoted ? "'" + text + "'" : "'" + text.substr(0, kMaxQuoted) + "…'";
}

// One element under test: where its problems go, and its numbers.
class Values {
 public:
  Values(const XmlOutline& xml, std::string element, std::vector<UrdfProblem>& problems)
      : xml_(xml), element_(std::move(element)), problems_(problems) {}

  void Say(Kind kind, int at, std::string what, std::string suggestion) {
    problems_.push_back({kind, xml_[at].line, element_, std::move(what), std::move(suggestion)});
  }

  // The numbers of an attribute; nullopt, and a problem, when there are not `count` finite ones.
  // An attribute that is absent is no problem unless it is `needed`.
  std::optional<std::vector<double>> Numbers(int at, const char* name, std::size_t count,
                                             bool is_needed = false) {
    const std::string* text = xml_[at].Attribute(name);
    const std::string attribute = fmt::format("<{}> {}", xml_[at].tag, name);
    if (text == nullptr) {
      if (is_needed) {
        Say(Kind::kUnreadable, at, attribute + " is missing",
            fmt::format("write {}=\"{}\"", name, count == 1 ? "a number" : "numbers"));
      }
      return std::nullopt;
    }
    std::vector<double> numbers;
    if (!Read(*text, count, numbers)) {
      Say(Kind::kUnreadable, at, attribute + "=" + Quoted(*text),
          fmt::format("write {} finite number{}", count, count == 1 ? "" : "s"));
      return std::nullopt;
    }
    return numbers;
  }
  std::optional<double> Number(int at, const char* name, bool is_needed = false) {
    const auto numbers = Numbers(at, name, 1, is_needed);
    return numbers ? std::optional(numbers->front()) : std::nullopt;
  }

  const XmlOutline& xml() const { return xml_; }
  const std::string& element() const { return element_; }

 private:
  // Stops at the first too many: the text may be megabytes.
  static bool Read(std::string_view text, std::size_t count, std::vector<double>& numbers) {
    constexpr std::string_view kBlanks = " \t\r\n";
    for (std::size_t at = text.find_first_not_of(kBlanks); at != text.npos;
         at = text.find_first_not_of(kBlanks, at)) {
      if (text[at] == '+') ++at;
      const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
      double value = 0;
      const auto [stop, error] = std::from_chars(text.data() + at, text.data() + end, value);
      if (error != std::errc() || stop != text.data() + end || !std::isfinite(value)) return false;
      if (numbers.size() == count) return false;
      numbers.push_back(value);
      at = end;
    }
    return numbers.size() == count;
  }

  const XmlOutline& xml_;
  std::string element_;
  std::vector<UrdfProblem>& problems_;
};

void CheckOrigin(Values& values, int owner) {
  const int origin = values.xml().Child(owner, "origin");
  if (origin < 0) return;
  if (const auto xyz = values.Numbers(origin, "xyz", 3)) {
    for (const double each : *xyz) {
      if (std::abs(each) <= kMaxMeters) continue;
      values.Say(Kind::kUnreadable, origin, fmt::format("<origin> is {:g} m away", each),
                 fmt::format("expected at most {:g} m; convert millimetres to metres", kMaxMeters));
      break;
    }
  }
  values.Numbers(origin, "rpy", 3);
}

void CheckLength(Values& values, int shape, const char* name, std::size_t count) {
  const auto lengths = values.Numbers(shape, name, count, true);
  if (!lengths) return;
  const std::string what = fmt::format("<{}> {}", values.xml()[shape].tag, name);
  for (const double each : *lengths) {
    if (each < 0) {
      values.Say(Kind::kUnreadable, shape, fmt::format("{} is negative: {:g} m", what, each),
                 "expected 0 m or more");
    } else if (each > kMaxMeters) {
      values.Say(Kind::kUnreadable, shape, fmt::format("{} is {:g} m", what, each),
                 fmt::format("expected at most {:g} m; convert millimetres to metres", kMaxMeters));
    } else if (each == 0) {
      values.Say(Kind::kWarning, shape, what + " is 0, so nothing is visible",
                 "give it a size, or remove the shape");
    } else {
      continue;
    }
    break;
  }
}

void CheckMesh(Values& values, int mesh, std::vector<NamedMesh>& meshes) {
  const std::string* uri = values.xml()[mesh].Attribute("filename");
  if (uri == nullptr || uri->empty()) {
    values.Say(Kind::kUnreadable, mesh, "<mesh> has no filename",
               "write filename=\"package://NAME/meshes/part.stl\"");
  } else {
    meshes.push_back({*uri, values.element(), values.xml()[mesh].line});
  }
  const auto scale = values.Numbers(mesh, "scale", 3);
  if (!scale) return;
  for (const double each : *scale) {
    if (each != 0 && std::abs(each) <= kMaxScale) continue;
    values.Say(each == 0 ? Kind::kWarning : Kind::kUnreadable, mesh,
               fmt::format("<mesh> scale is {:g}", each),
               fmt::format("expected a number other than 0, up to {:g}", kMaxScale));
    return;
  }
}

void CheckShape(Values& values, int owner, std::vector<NamedMesh>& meshes) {
  CheckOrigin(values, owner);
  const XmlOutline& xml = values.xml();
  const int geometry = xml.Child(owner, "geometry");
  const int shape = geometry < 0 ? -1 : xml[geometry].first_child;
  if (shape < 0) {
    values.Say(Kind::kUnreadable, owner, fmt::format("<{}> has no shape", xml[owner].tag),
               "put <box>, <cylinder>, <sphere> or <mesh> into its <geometry>");
    return;
  }
  const std::string& tag = xml[shape].tag;
  if (tag == "box") {
    CheckLength(values, shape, "size", 3);
  } else if (tag == "sphere") {
    CheckLength(values, shape, "radius", 1);
  } else if (tag == "cylinder") {
    CheckLength(values, shape, "radius", 1);
    CheckLength(values, shape, "length", 1);
  } else if (tag == "mesh") {
    CheckMesh(values, shape, meshes);
  } else {
    values.Say(Kind::kUnreadable, shape, "<" + tag + "> is not a shape of a URDF",
               "expected <box>, <cylinder>, <sphere> or <mesh>");
  }
}

void CheckTensor(Values& values, int element, const Eigen::Matrix3d& tensor, double mass) {
  if (tensor.isZero(0)) {
    if (mass > 0) {
      values.Say(Kind::kWarning, element, fmt::format("no inertia for {:g} kg", mass),
                 "simulators need one: give the inertia of the shape, or remove <inertial>");
    }
    return;
  }
  const Eigen::Vector3d moments =  // ascending
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor, Eigen::EigenvaluesOnly).eigenvalues();
  const std::string text =
      fmt::format("principal moments {:g} {:g} {:g} kg m²", moments[0], moments[1], moments[2]);
  if (!(moments[0] > 0)) {
    values.Say(Kind::kWrong, element, "<inertia> is not positive definite: " + text,
               "impossible for a real body; check signs and off-diagonal values");
  } else if (moments[0] + moments[1] < moments[2] * (1 - kTriangleSlack)) {
    values.Say(Kind::kWrong, element,
               "<inertia> breaks the triangle inequality (two moments are together at least the "
               "third): " +
                   text,
               "impossible for a real body; check the reference point and the order of the values");
  }
}

void CheckMass(Values& values, int at, double mass, bool moves) {
  if (mass < 0) {
    values.Say(Kind::kWrong, at, fmt::format("its mass is negative: {:g} kg", mass),
               "expected more than 0 kg");
  } else if (mass > kMaxMass) {
    values.Say(Kind::kWrong, at, fmt::format("its mass is {:g} kg", mass),
               fmt::format("expected at most {:g} kg; convert grams to kilograms", kMaxMass));
  } else if (mass == 0 && moves) {
    values.Say(Kind::kWarning, at, "it moves and has no mass",
               "fine for RViz and TF; Gazebo leaves it out, with all its child links");
  }
}

// A root or a link that is welded on needs none.
double CheckInertial(Values& values, int link, bool moves) {
  const XmlOutline& xml = values.xml();
  const int inertial = xml.Child(link, "inertial");
  if (inertial < 0) {
    CheckMass(values, link, 0, moves);
    return 0;
  }
  CheckOrigin(values, inertial);
  const int mass_at = xml.Child(inertial, "mass");
  const int tensor_at = xml.Child(inertial, "inertia");
  for (const auto& [at, tag] : {std::pair(mass_at, "mass"), std::pair(tensor_at, "inertia")}) {
    if (at >= 0) continue;
    values.Say(Kind::kUnreadable, inertial, fmt::format("<inertial> has no <{}>", tag),
               "add it, or remove <inertial>");
  }
  const auto mass = mass_at < 0 ? std::nullopt : values.Number(mass_at, "value", true);
  if (mass) CheckMass(values, mass_at, *mass, moves);
  if (tensor_at >= 0) {
    static constexpr std::array kNames = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};
    std::array<double, 6> i{};
    bool is_whole = true;
    for (std::size_t k = 0; k < i.size(); ++k) {
      const auto value = values.Number(tensor_at, kNames[k], true);
      is_whole = is_whole && value;
      i[k] = value.value_or(0);
    }
    Eigen::Matrix3d tensor;
    tensor << i[0], i[1], i[2], i[1], i[3], i[4], i[2], i[4], i[5];
    if (is_whole) CheckTensor(values, tensor_at, tensor, mass.value_or(0));
  }
  return mass.value_or(0);
}

void CheckLimits(Values& values, int joint, const std::string& type) {
  const int limit = values.xml().Child(joint, "limit");
  const bool is_needed = type == "revolute" || type == "prismatic";
  if (limit < 0) {
    if (!is_needed) return;
    values.Say(Kind::kUnreadable, joint, "a " + type + " joint without <limit>",
               type == "revolute" ? "add one, or make it continuous" : "add one");
    return;
  }
  const double lower = values.Number(limit, "lower").value_or(0);
  const double upper = values.Number(limit, "upper").value_or(0);
  if (lower > upper) {
    values.Say(Kind::kWrong, limit, fmt::format("lower {:g} is above upper {:g}", lower, upper),
               "swap them; angles are radians");
  } else if (is_needed && lower == upper) {
    values.Say(Kind::kWarning, limit, fmt::format("it cannot move: lower = upper = {:g}", lower),
               "give it a range, or make it fixed");
  }
  for (const char* name : {"effort", "velocity"}) {
    const auto value = values.Number(limit, name, true);
    if (!value || *value >= 0) continue;
    values.Say(Kind::kWrong, limit, fmt::format("{} is negative: {:g}", name, *value),
               "expected 0 or more");
  }
}

void CheckAxis(Values& values, int joint) {
  const int at = values.xml().Child(joint, "axis");
  const auto axis = at < 0 ? std::nullopt : values.Numbers(at, "xyz", 3);
  if (!axis) return;
  const double length = Eigen::Vector3d((*axis)[0], (*axis)[1], (*axis)[2]).norm();
  if (!(length > 1e-6)) {
    values.Say(Kind::kUnreadable, at, "<axis> has length 0, so it gives no direction",
               "write a direction, such as xyz=\"1 0 0\"");
  } else if (std::abs(length - 1) > 1e-3) {
    values.Say(Kind::kWarning, at, fmt::format("<axis> has the length {:g}", length),
               "only its direction is used; give it length 1");
  }
}

}  // namespace

std::string Called(const std::string& tag, const std::string& name) {
  return tag + " " + Quoted(name);
}

double CheckLink(const XmlOutline& xml, int link, bool moves, std::vector<NamedMesh>& meshes,
                 std::vector<UrdfProblem>& problems) {
  const std::string* name = xml[link].Attribute("name");
  Values values(xml, Called("link", name != nullptr ? *name : ""), problems);
  const double mass = CheckInertial(values, link, moves);
  for (int part = xml[link].first_child; part >= 0; part = xml[part].next_sibling) {
    const std::string& tag = xml[part].tag;
    if (tag == "visual" || tag == "collision") CheckShape(values, part, meshes);
    if (tag != "visual") continue;
    const int material = xml.Child(part, "material");
    if (material >= 0) CheckMaterial(xml, material, values.element(), problems);
  }
  return mass;
}

void CheckJoint(const XmlOutline& xml, int joint, std::vector<UrdfProblem>& problems) {
  const std::string* name = xml[joint].Attribute("name");
  const std::string* type = xml[joint].Attribute("type");
  Values values(xml, Called("joint", name != nullptr ? *name : ""), problems);
  CheckOrigin(values, joint);
  if (type == nullptr) {
    values.Say(Kind::kUnreadable, joint, "it has no type",
               "write a type, such as type=\"revolute\"");
    return;
  }
  static constexpr std::array<std::string_view, 6> kTypes = {"fixed",     "revolute", "continuous",
                                                             "prismatic", "floating", "planar"};
  if (std::find(kTypes.begin(), kTypes.end(), *type) == kTypes.end()) {
    values.Say(Kind::kUnreadable, joint, "unknown type " + Quoted(*type),
               "expected fixed, revolute, continuous, prismatic, floating or planar");
    return;
  }
  if (*type == "floating" || *type == "planar") {
    values.Say(Kind::kWarning, joint, "it is " + *type + ": drawn at its origin",
               "joint states cannot describe this joint type; use TF");
  } else if (*type != "fixed") {
    CheckAxis(values, joint);
    CheckLimits(values, joint, *type);
  }
  const int mimic = xml.Child(joint, "mimic");
  if (mimic < 0) return;
  values.Number(mimic, "multiplier");
  values.Number(mimic, "offset");
}

void CheckMaterial(const XmlOutline& xml, int material, const std::string& owner,
                   std::vector<UrdfProblem>& problems) {
  Values values(xml, owner, problems);
  const int color = xml.Child(material, "color");
  if (color >= 0) {
    const auto rgba = values.Numbers(color, "rgba", 4, true);
    const bool is_off = rgba && std::any_of(rgba->begin(), rgba->end(),
                                            [](double each) { return each < 0 || each > 1; });
    if (is_off) {
      values.Say(Kind::kWarning, color, "<color> rgba is not within 0 to 1",
                 "divide values of 0 to 255 by 255");
    }
  }
  const int texture = xml.Child(material, "texture");
  if (texture >= 0) {
    values.Say(Kind::kWarning, texture, "textures are not drawn", "give it a <color> as well");
  }
}

}  // namespace kinescope::urdf
