/// The style and the script of the page of a study: the files of study/page/. Constants.
#pragma once

namespace kinescope::app {

extern const char* const kStudyStyle;
extern const char* const kStudyScript;

}  // namespace kinescope::app
