#include "render/vtk/number_shader.h"

#include <vtkActor.h>
#include <vtkShaderProperty.h>
#include <vtkUniforms.h>

#include "core/system/check.h"
#include "render/vtk/pass_actor.h"

namespace kinescope::render {
namespace {

constexpr char kDeclarations[] = "//VTK::Color::Dec", kVertexEnd[] = "//VTK::CustomEnd::Impl",
               kFragment[] = "//VTK::Light::Impl", kReturn[] = "  return;\n",
               kFirst[] = "firstNumber";
constexpr int kThrough = 128;  // in the blue byte

// What the actor's own text makes fully transparent stays so.
std::string NumberText(bool is_through) {
  return "  gl_FragData[0] = vec4(float(numberVS & 255), float((numberVS >> 8) & 255), "
         "float((numberVS >> 16) & 127) + " +
         std::string(is_through ? "128.0" : "0.0") +
         ", gl_FragData[0].a > 0.0 ? 255.0 : 0.0) / 255.0;\n";
}

}  // namespace

PixelNumber NumberOf(const std::uint8_t* rgba) {
  return {rgba[0] | rgba[1] << 8 | (rgba[2] & (kThrough - 1)) << 16, (rgba[2] & kThrough) != 0};
}

NumberShader::NumberShader(vtkActor* actor, int first, bool by_part) : actor_(actor) {
  vtkShaderProperty* const shader = actor->GetShaderProperty();
  for (vtkIdType i = 0; i < shader->GetNumberOfShaderReplacements(); ++i) {
    Text text;
    bool is_first = false, is_all = false;
    text.is_vertex = shader->GetNthShaderReplacementTypeAsString(i) == "Vertex";
    shader->GetNthShaderReplacement(i, text.token, is_first, text.replacement, is_all);
    before_.push_back(std::move(text));
  }
  const auto* const pass = dynamic_cast<const PassActor*>(actor);
  KINESCOPE_CHECK(pass != nullptr);
  for (Text text : before_) {
    if (text.token == kDeclarations) {
      text.replacement += text.is_vertex ? "flat out int numberVS;\n" : "flat in int numberVS;\n";
    } else if (text.token == kVertexEnd) {
      text.replacement +=
          std::string("  numberVS = ") + kFirst + (by_part ? " + int(part + 0.5);\n" : ";\n");
    } else if (text.token == kFragment) {
      const std::size_t end = text.replacement.rfind(kReturn);
      KINESCOPE_CHECK(end != std::string::npos);
      text.replacement.insert(end, NumberText(pass->pass() == Pass::kGhost));
    }
    Set(text);
  }
  shader->GetVertexCustomUniforms()->SetUniformi(kFirst, first);
}

NumberShader::~NumberShader() {
  for (const Text& text : before_) Set(text);
  actor_->GetShaderProperty()->GetVertexCustomUniforms()->RemoveUniform(kFirst);
}

void NumberShader::Set(const Text& text) {
  vtkShaderProperty* const shader = actor_->GetShaderProperty();
  if (text.is_vertex) {
    shader->AddVertexShaderReplacement(text.token, true, text.replacement, false);
  } else {
    shader->AddFragmentShaderReplacement(text.token, true, text.replacement, false);
  }
}

}  // namespace kinescope::render
