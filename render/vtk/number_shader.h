/// Makes an actor draw numbers in the place of its colours, with the shader that places its
/// vertices otherwise, so that a picture of numbers shows what the picture shows.
#pragma once

#include <vtkSmartPointer.h>

#include <cstdint>
#include <string>
#include <vector>

class vtkActor;

namespace kinescope::render {

struct PixelNumber {
  int number = 0;           // 0: nothing
  bool is_through = false;  // it shines through what is in front
};

/// Of four bytes of a picture of numbers.
PixelNumber NumberOf(const std::uint8_t* rgba);

/// For as long as it lives. While the context of the actor's window is current; one thread.
class NumberShader {
 public:
  /// `first` from 1; `by_part`: the parts of the actor are `first`, `first` + 1, ...
  /// @pre the actor is that of a ShadedActor
  NumberShader(vtkActor* actor, int first, bool by_part);
  ~NumberShader();
  NumberShader(const NumberShader&) = delete;
  NumberShader& operator=(const NumberShader&) = delete;

 private:
  struct Text {
    bool is_vertex = false;
    std::string token, replacement;
  };
  void Set(const Text& text);

  vtkSmartPointer<vtkActor> actor_;
  std::vector<Text> before_;
};

}  // namespace kinescope::render
