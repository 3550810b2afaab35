/// Makes files of a recorded trial with other commands of this program, each in a process of its
/// own, so that whatever a recording contains, the server goes on. For the workshop's thread.
#pragma once

#include <filesystem>

#include "server/app/serve/option_texts.h"
#include "server/app/serve/workshop.h"

namespace kinescope::app {

/// By `kinescope loads`. @throws std::exception with the last line of the program's error
void MakeReport(const std::filesystem::path& recording, const std::filesystem::path& report,
                const OptionTexts& options, const Workshop::Progress& progress);

/// By `kinescope render`: of a trial whose states this server does not have. @throws std::exception
/// with the last line of the program's error
void MakeRecordedClip(const std::filesystem::path& recording, const std::filesystem::path& clip,
                      const OptionTexts& options, const Workshop::Progress& progress);

}  // namespace kinescope::app
