#include "urdf/mesh/mesh_gate.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "urdf/mesh/mesh_file.h"
#include "urdf/mesh/stl_gate.h"
#include "urdf/rig/glb_container.h"
#include "urdf/robot/xml_outline.h"

namespace kinescope::urdf {
namespace {

using nlohmann::json;
using Fault = std::runtime_error;

constexpr std::size_t kMaxNodes = 20'000;  // of a scene, instances counted
constexpr int kMaxDepth = 100;             // of nodes

// Nodes that hold nodes: how many there are once every reference is followed.
class NodeGraph {
 public:
  void Add(const std::string& from, const std::string& to) { children_[from].push_back(to); }

  void Check() {
    std::map<std::string, Size> sizes;
    for (const auto& [node, children] : children_) SizeOf(node, 0, sizes);
  }

 private:
  struct Size {
    bool is_open = true;  // being counted: to meet it again is a circle
    std::size_t nodes = 1;
  };

  std::size_t SizeOf(const std::string& node, int depth, std::map<std::string, Size>& sizes) {
    if (depth > kMaxDepth) throw Fault("its nodes are nested too deeply");
    const auto [known, is_new] = sizes.emplace(node, Size{});
    if (!is_new && known->second.is_open) throw Fault("node '" + node + "' contains itself");
    if (!is_new) return known->second.nodes;
    const auto children = children_.find(node);
    if (children != children_.end()) {
      for (const std::string& child : children->second) {
        known->second.nodes += SizeOf(child, depth + 1, sizes);
        if (known->second.nodes > kMaxNodes) throw Fault("it expands to too many nodes");
      }
    }
    known->second.is_open = false;
    return known->second.nodes;
  }

  std::map<std::string, std::vector<std::string>> children_;
};

const char* FindAttribute(const char* const* attributes, std::string_view name) {
  for (; *attributes != nullptr; attributes += 2) {
    if (name == attributes[0]) return attributes[1];
  }
  return nullptr;
}

// A number of things of which each takes a byte of the file at least.
void CheckCount(std::string_view text, std::size_t bytes, const std::string& where) {
  std::uint64_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (is_number && count <= bytes) return;
  throw Fault(where + " declares a count of " + std::string(text.substr(0, 30)) +
              ", but the file has " + std::to_string(bytes) + " bytes");
}

// assimp waits for ever at the first character of an index that is no digit.
void CheckIndices(const std::string& bytes) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::size_t at = bytes.find('<'); at != bytes.npos; at = bytes.find('<', at + 1)) {
    const std::size_t end = bytes.find_first_of(" \t\r\n/>", at + 1);
    const std::size_t close = bytes.find('>', at);
    if (end == bytes.npos || close == bytes.npos) return;
    const std::string_view tag = std::string_view(bytes).substr(at + 1, end - at - 1);
    const bool has_indices = tag == "p" || tag == "v" || tag == "vcount" || tag == "h";
    if (!has_indices || bytes[close - 1] == '/') continue;
    for (std::size_t i = close + 1; i + 1 < bytes.size(); ++i) {
      const char c = bytes[i], next = bytes[i + 1];
      if (c == '<' && next == '/') break;
      const bool is_blank = c == ' ' || c == '\t' || c == '\r' || c == '\n';
      if (is_digit(c) || is_blank || (c == '-' && is_digit(next))) continue;
      throw Fault("<" + std::string(tag) + "> contains a value that is not an index");
    }
  }
}

void CheckDae(const std::string& bytes) {
  NodeGraph graph;
  std::vector<std::string> open;  // by depth: the node that we are in
  const urdf::XmlLimits limits{kMaxMeshBytes, 500'000, kMaxDepth};
  int nameless = 0;
  urdf::ScanXml(
      bytes, limits, [&](const char* tag, const char* const* attributes, int line, int depth) {
        const std::string_view name = tag;
        const std::string where = "line " + std::to_string(line) + ": <" + tag + ">";
        open.resize(static_cast<std::size_t>(depth));
        const std::string outer = open.empty() ? "" : open.back();
        std::string inner = outer;
        if (name == "node") {
          // assimp finds a node by its id, else by its name.
          const char* id = FindAttribute(attributes, "id");
          if (id == nullptr) id = FindAttribute(attributes, "name");
          inner = id != nullptr ? "#" + std::string(id) : std::to_string(++nameless);
          graph.Add(outer, inner);
        } else if (name == "instance_node") {
          const char* url = FindAttribute(attributes, "url");
          if (url != nullptr) graph.Add(outer, url);
        }
        open.push_back(inner);
        const bool has_count = name == "float_array" || name == "int_array" || name == "accessor" ||
                               name == "Name_array" || name == "IDREF_array" ||
                               name == "triangles" || name == "polylist" || name == "polygons" ||
                               name == "lines" || name == "vertex_weights";
        const char* count = has_count ? FindAttribute(attributes, "count") : nullptr;
        if (count != nullptr) CheckCount(count, bytes.size(), where);
      });
  graph.Check();
  CheckIndices(bytes);
}

std::uint64_t Unsigned(const json& object, const char* name, std::uint64_t otherwise) {
  const auto member = object.find(name);
  if (member == object.end()) return otherwise;
  if (!member->is_number_unsigned()) throw Fault(std::string(name) + " is not a whole number");
  return member->get<std::uint64_t>();
}

const json& Array(const json& document, const char* name) {
  static const json kNone = json::array();
  const auto member = document.find(name);
  if (member == document.end()) return kNone;
  if (!member->is_array()) throw Fault(std::string(name) + " is not a list");
  for (const json& each : *member) {
    if (!each.is_object())
      throw Fault(std::string(name) + " contains a value that is not an object");
  }
  return *member;
}

// Sizes of components and of elements, as glTF names them.
std::uint64_t ElementBytes(const json& accessor) {
  static const std::map<std::uint64_t, std::uint64_t> kComponent = {
      {5120, 1}, {5121, 1}, {5122, 2}, {5123, 2}, {5125, 4}, {5126, 4}};
  static const std::map<std::string, std::uint64_t> kElement = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  const auto component = kComponent.find(Unsigned(accessor, "componentType", 0));
  const auto type = accessor.find("type");
  if (component == kComponent.end() || type == accessor.end() || !type->is_string()) {
    throw Fault("an accessor has an unknown type");
  }
  const auto element = kElement.find(type->get<std::string>());
  if (element == kElement.end()) throw Fault("an accessor has an unknown type");
  return component->second * element->second;
}

void CheckBuffers(const json& document, std::uint64_t binary_bytes) {
  const json& buffers = Array(document, "buffers");
  if (buffers.size() > 1) throw Fault("it has more than one buffer; a GLB has only one");
  for (const json& buffer : buffers) {
    if (buffer.contains("uri")) throw Fault("it refers to other files; pack them into the GLB");
    if (Unsigned(buffer, "byteLength", 0) > binary_bytes) {
      throw Fault("its buffer declares " + std::to_string(Unsigned(buffer, "byteLength", 0)) +
                  " bytes, but the file has " + std::to_string(binary_bytes));
    }
  }
  const json& views = Array(document, "bufferViews");
  for (const json& view : views) {
    const std::uint64_t offset = Unsigned(view, "byteOffset", 0);
    const std::uint64_t length = Unsigned(view, "byteLength", 0);
    if (Unsigned(view, "buffer", 0) >= buffers.size() || offset > binary_bytes ||
        length > binary_bytes - offset || Unsigned(view, "byteStride", 0) > 252) {
      throw Fault("a bufferView lies outside the buffer");
    }
  }
  for (const json& accessor : Array(document, "accessors")) {
    if (accessor.contains("sparse")) throw Fault("sparse accessors are not supported");
    const std::uint64_t element = ElementBytes(accessor);
    const std::uint64_t count = Unsigned(accessor, "count", 0);
    const std::uint64_t offset = Unsigned(accessor, "byteOffset", 0);
    const std::uint64_t index = Unsigned(accessor, "bufferView", views.size());
    if (index >= views.size()) throw Fault("an accessor has no bufferView");
    const std::uint64_t length = Unsigned(views[index], "byteLength", 0);
    const std::uint64_t stride = std::max(Unsigned(views[index], "byteStride", element), element);
    // The last element needs no room for the rest of its stride.
    if (count == 0 || offset > length || element > length - offset ||
        count - 1 > (length - offset - element) / stride) {
      throw Fault("an accessor declares a count of " + std::to_string(count) +
                  ", but its bufferView has " + std::to_string(length) + " bytes");
    }
  }
}

void CheckReferences(const json& document) {
  const auto count_of = [&](const char* list) { return Array(document, list).size(); };
  const auto check = [&](const json& index, const char* list) {
    if (index.is_number_unsigned() && index.get<std::uint64_t>() < count_of(list)) return;
    throw Fault(std::string("it refers to an entry of ") + list + " that does not exist");
  };
  NodeGraph graph;
  const json& nodes = Array(document, "nodes");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].contains("mesh")) check(nodes[i]["mesh"], "meshes");
    if (!nodes[i].contains("children")) continue;
    if (!nodes[i]["children"].is_array()) throw Fault("children is not a list");
    for (const json& child : nodes[i]["children"]) {
      check(child, "nodes");
      graph.Add(std::to_string(i), std::to_string(child.get<std::uint64_t>()));
    }
  }
  graph.Check();
  for (const json& scene : Array(document, "scenes")) {
    if (!scene.contains("nodes")) continue;
    if (!scene["nodes"].is_array()) throw Fault("nodes of a scene is not a list");
    for (const json& node : scene["nodes"]) check(node, "nodes");
  }
  for (const json& mesh : Array(document, "meshes")) {
    for (const json& primitive : Array(mesh, "primitives")) {
      if (primitive.contains("indices")) check(primitive["indices"], "accessors");
      if (primitive.contains("material")) check(primitive["material"], "materials");
      if (!primitive.contains("attributes") || !primitive["attributes"].is_object()) {
        throw Fault("a primitive has no attributes");
      }
      for (const json& attribute : primitive["attributes"]) check(attribute, "accessors");
    }
  }
}

void CheckGlb(const std::string& bytes) {
  const GlbChunks chunks = SplitGlb(bytes);
  const json document = ParseGlbJson(chunks.json);
  const json extensions = document.value("extensionsRequired", json::array());
  if (!extensions.empty()) throw Fault("unsupported extension: " + extensions.dump().substr(0, 80));
  CheckBuffers(document, chunks.binary.size());
  CheckReferences(document);
}

}  // namespace

void CheckMeshBytes(const std::string& bytes, const std::string& extension) {
  if (bytes.empty()) throw Fault("the file is empty");
  if (extension == ".stl") return CheckStl(bytes);
  if (extension == ".dae") return CheckDae(bytes);
  if (extension == ".glb") {
    try {
      return CheckGlb(bytes);
    } catch (const json::exception& error) {
      throw Fault(std::string("its JSON part is invalid: ") + error.what());
    }
  }
  if (extension == ".obj") return;  // announces nothing
  throw Fault("unsupported mesh format '" + extension + "'; expected .stl, .dae, .obj or .glb");
}

}  // namespace kinescope::urdf
