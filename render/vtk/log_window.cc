#include "render/vtk/log_window.h"

#include <GL/glew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>
#include <vtkTimerLog.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "core/system/utf8.h"

namespace kinescope::render {
namespace {

thread_local const LogLine* current_log = nullptr;

// Lines and runs of blanks become one blank; VTK's text starts with the place in its source.
std::string OneLine(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool is_blank = c == '\n' || c == '\r' || c == '\t' || c == ' ';
    if (!is_blank) line += c;
    if (is_blank && !line.empty() && line.back() != ' ') line += ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

// Synchronous, so on the thread that made the GL call. `log` is the OnceLog of the renderer.
void GLAPIENTRY OnGlMessage(GLenum /*source*/, GLenum type, GLuint /*id*/, GLenum severity,
                            GLsizei length, const GLchar* message, const void* log) {
  const std::string text =
      length >= 0 ? std::string(message, static_cast<std::size_t>(length)) : std::string(message);
  const char* kind = type == GL_DEBUG_TYPE_ERROR ? "error" : "warning";
  if (severity == GL_DEBUG_SEVERITY_HIGH && type != GL_DEBUG_TYPE_ERROR) kind = "severe warning";
  auto* once = static_cast<OnceLog*>(const_cast<void*>(log));
  (*once)(std::string("gl: ") + kind + ": " + OneLine(text));
}

class LineWindow : public vtkOutputWindow {
 public:
  static LineWindow* New();

  void DisplayText(const char* text) override {
    if (text == nullptr) return;
    LogHere("vtk: " + std::string(text));
  }
  void DisplayErrorText(const char* text) override { DisplayText(text); }
  void DisplayWarningText(const char* text) override { DisplayText(text); }
  void DisplayGenericWarningText(const char* text) override { DisplayText(text); }
  void DisplayDebugText(const char* text) override { DisplayText(text); }
};

vtkStandardNewMacro(LineWindow)

}  // namespace

void LogHere(const std::string& text) {
  const std::string line = OneLine(text);
  if (current_log != nullptr) {
    (*current_log)(line);
  } else {
    std::fprintf(stderr, "render: %s\n", PrintableLine(line).c_str());
  }
}

void LogGlMessages(OnceLog& log) {
  if (glDebugMessageCallback == nullptr || glDebugMessageControl == nullptr) return;
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  // Mesa's remarks on performance (a shader recompiled) come at severity low or as notifications.
  glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
  for (const GLenum severity : {GL_DEBUG_SEVERITY_HIGH, GL_DEBUG_SEVERITY_MEDIUM}) {
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, severity, 0, nullptr, GL_TRUE);
  }
  glDebugMessageCallback(&OnGlMessage, &log);
}

VtkLogScope::VtkLogScope(const LogLine& log) : outer_(current_log) {
  static const bool installed = [] {
    vtkOutputWindow::SetInstance(vtkSmartPointer<LineWindow>::New());
    // One list per process: every drawing thread writes into it at every picture, without a lock.
    vtkTimerLog::LoggingOff();
    return true;
  }();
  static_cast<void>(installed);
  current_log = &log;
}

VtkLogScope::~VtkLogScope() { current_log = outer_; }

}  // namespace kinescope::render
