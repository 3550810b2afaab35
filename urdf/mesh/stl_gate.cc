#include "urdf/mesh/stl_gate.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "urdf/mesh/mesh_file.h"

namespace kinescope::urdf {
namespace {

using Fault = std::runtime_error;

// assimp leaks what it has made so far of a text that it then refuses; so it only gets what it will
// not refuse: solids of facets, each with a normal and three vertices.
class TextStl {
 public:
  explicit TextStl(std::string_view text) : text_(text) {}

  void Check() {
    if (text_.find('\0') != text_.npos) throw Fault("it contains zero bytes, so it is not text");
    while (BeginSolid()) {
      std::string_view word = Word();
      // The end of the last solid may be missing.
      for (; !word.empty() && !BeginsWith(word, "endsolid"); word = Word()) {
        if (word == "facet") Facet();
        if (word == "vertex") Vertex();
      }
      EndSolid();
    }
  }

 private:
  static bool IsBlank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f';
  }

  std::string_view Word() {
    while (at_ < text_.size() && IsBlank(text_[at_])) ++at_;
    const std::size_t begin = at_;
    while (at_ < text_.size() && !IsBlank(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  // Empty when the line ends first.
  std::string_view WordOfLine() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    return at_ < text_.size() && IsBlank(text_[at_]) ? std::string_view() : Word();
  }

  static bool BeginsWith(std::string_view word, std::string_view with) {
    return word.substr(0, with.size()) == with;
  }

  // What follows the last solid is not looked at.
  bool BeginSolid() {
    if (!BeginsWith(Word(), "solid")) return false;
    SkipLine();  // its name
    facets_ = vertices_ = 0;
    return true;
  }

  void SkipLine() { at_ = std::min(text_.find_first_of("\r\n", at_), text_.size()); }

  void Facet() {
    if (vertices_ != 3 * facets_) throw Wrong("a facet has fewer than three vertices");
    ++facets_;
    if (facets_ > kMaxMeshTriangles) {
      throw Fault("more than " + std::to_string(kMaxMeshTriangles) + " triangles");
    }
    if (WordOfLine() != "normal") throw Wrong("a facet has no normal");
    Numbers("a normal");
  }

  void Vertex() {
    if (++vertices_ > 3 * facets_) throw Wrong("a facet has more than three vertices");
    Numbers("a vertex");
  }

  void EndSolid() {
    if (vertices_ != 3 * facets_) throw Wrong("a facet has fewer than three vertices");
    if (facets_ == 0) throw Wrong("a solid has no facets");
    SkipLine();
  }

  void Numbers(const std::string& of) {
    for (int i = 0; i < 3; ++i) {
      std::string_view word = WordOfLine();
      if (!word.empty() && word.front() == '+') word.remove_prefix(1);
      double value = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      const bool is_number = error == std::errc() && end == word.data() + word.size();
      if (!is_number || !std::isfinite(value)) throw Wrong(of + " does not have three numbers");
    }
  }

  Fault Wrong(const std::string& what) const {
    const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<long>(at_), '\n');
    return Fault("line " + std::to_string(line) + ": " + what);
  }

  const std::string_view text_;
  std::size_t at_ = 0;
  std::size_t facets_ = 0, vertices_ = 0;  // of this solid
};

std::uint32_t StlWord(const std::string& bytes, std::size_t at) {  // little-endian
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) word = word << 8 | static_cast<unsigned char>(bytes[at + i]);
  return word;
}

}  // namespace

void CheckStl(const std::string& bytes) {
  constexpr std::size_t kHeader = 84, kTriangle = 50;
  const bool is_text = bytes.compare(0, 5, "solid") == 0;
  if (bytes.size() < kHeader) {
    if (is_text) return TextStl(bytes).Check();
    throw Fault("too short for an STL: " + std::to_string(bytes.size()) + " bytes");
  }
  const std::uint64_t triangles = StlWord(bytes, kHeader - 4);
  const std::uint64_t expected = kHeader + kTriangle * triangles;
  if (is_text && expected != bytes.size()) return TextStl(bytes).Check();
  if (expected > bytes.size()) {
    throw Fault("it declares " + std::to_string(triangles) + " triangles (" +
                std::to_string(expected) + " bytes), but has " + std::to_string(bytes.size()) +
                " bytes");
  }
  if (triangles > kMaxMeshTriangles) {
    throw Fault("more than " + std::to_string(kMaxMeshTriangles) + " triangles");
  }
}

}  // namespace kinescope::urdf
