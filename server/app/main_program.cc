#include "server/app/commands.h"
#include "server/app/program.h"

int main(int argc, char** argv) {
  return kinescope::app::RunProgram(argc, argv, kinescope::app::MainCommands);
}
