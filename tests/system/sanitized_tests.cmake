# The tests that `ctest --preset dev-sanitized-program` runs with the sanitized program: they give it bytes of others, or end it
# midway. Refusals of options, and what is made of the built-in subjects, are tested with sanitizers in the libraries.
set(sanitized_tests
  Command.CountsRejectedDatagramsByReasonAndContinues
  Command.RejectsInvalidSources
  Command.RendersRealRecordings
  Inspect.ReceivesTcpUntilCtrlCAndThenReports
  Inspect.ReceivesUdpUntilCtrlCAndThenReports
  Inspect.RejectsUnreadableSourcesInOneLine
  Inspect.ReportsAFileOfDatagramsInJsonAndInText
  Inspect.ReportsErrorsWithTheirFirstPlace
  Inspect.ReportsThePersonAndOtherTopicsOfABag
  Inspect.ReportsVersionPersonAndRateOfAnMvnxFile
  LoadsCommand.ComputesStaticLoadsForABagOfPoses
  LoadsCommand.ComputesStaticLoadsWithTheReasonForAStreamOfPoses
  LoadsCommand.LeavesNoFilesWhenItIsStopped
  LoadsCommand.NamesTheFileThatDoesNotFitOnTheDiskAndLeavesNothing
  LoadsCommand.PlotsEveryJointAsPngAndSvg
  LoadsCommand.ReadsAFullBodyRecordingOfFourSamples
  LoadsCommand.ReportsThatStandardOutputIsFull
  LoadsCommand.TellsTheTimeWithForcesFromAFileAndRefusesABadFile
  LoadsCommand.WritesASelfContainedReport
  Record.ConvertsAFileOrAPipeToACapture
  Record.KeepsCompletePacketsOnAFullDisk
  Record.NamesAFileWithInvalidUtf8InJson
  Record.RecordsTcpAndEndsRegularlyOnCtrlC
  Record.SplitsItsFileBySizeAndNumbersTheFiles
  StreamCommand.ForwardsDatagramsByteForByte
  StreamCommand.RelaysALiveStreamUntilItIsStopped
  StreamCommand.SendsOnlyWhatARecordingContains
  StreamCommand.SendsOverTcp
  UrdfCommand.DistinguishesInvalidUrdfsFromUnreadableFiles
  UrdfCommand.PrintsRepeatedProblemsWithTheirNumber
  UrdfCommand.RendersAndChecksPublishedHumanModels
  UrdfCommand.ReportsAFullDiskAndKeepsTheOldFile
  UrdfCommand.ReportsFileLineAndElementOfAProblem
  UrdfCommand.WritesTheSkinOfAMoment)

# A name of no test would be left out without a word.
file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*_test.cc)
set(text "")
foreach(source IN LISTS sources)
  file(STRINGS ${source} lines REGEX "^TEST(_F)?\\(|^ +[A-Za-z0-9]+\\) {$")
  string(APPEND text "${lines};")
endforeach()
set(labels "")
foreach(name IN LISTS sanitized_tests)
  string(REPLACE "." ",[ ;]*" pattern ${name})
  if(NOT text MATCHES "\\(${pattern}\\)")
    message(FATAL_ERROR "tests/system/sanitized_tests.cmake: there is no test ${name}")
  endif()
  string(APPEND labels "set_tests_properties(system_test.${name} PROPERTIES LABELS \"system;sanitized\")\n")
endforeach()
file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/sanitized_labels.cmake CONTENT "${labels}")
# After those of the tests that the program tells.
set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/sanitized_labels.cmake)
