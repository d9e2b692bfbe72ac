#include <gtest/gtest.h>

#include <csignal>
#include <string>
#include <vector>

#include "fem/error.hpp"
#include "fem/formats/read_med.hpp"
#include "fem/formats/rehearsal.hpp"
#include "fem/formats/vtk/values.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon::fem;

namespace {

/// What the fault says; empty where there is none.
std::string fault_of(const std::function<void()>& reading) {
  const tenon::fem::testing::Scratch scratch;
  try {
    rehearse(scratch.write("part.med", "twelve bytes"), reading);
  } catch (const vtk::ArrayFault& fault) {
    return fault.what + ". " + fault.cure;
  }
  return {};
}

}  // namespace

TEST(Rehearsal, LeavesNothingBehindOfWhatGoesWell) {
  int done = 0;
  EXPECT_EQ(fault_of([&] { ++done; }), "");
  EXPECT_EQ(done, 0) << "in a process of its own";
}

TEST(Rehearsal, BringsAFaultOver) {
  EXPECT_EQ(fault_of([] {
              throw vtk::ArrayFault{"'NOD' is damaged", "Write it again"};
            }),
            "'NOD' is damaged. Write it again");
  const std::string large(1 << 20, 'x');  // more than a pipe holds
  EXPECT_EQ(fault_of([&] { throw vtk::ArrayFault{large, "y"}; }), large + ". y");
}

TEST(Rehearsal, SaysThatTheLibraryCameDown) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE})
    EXPECT_EQ(fault_of([=] { std::raise(signal); }).find("'part.med' is damaged: HDF5 itself fails"), 0U) << signal;
}

TEST(Rehearsal, EndsWhatDoesNotComeBack) {
  volatile bool for_ever = true;
  EXPECT_NE(fault_of([&] {
              while (for_ever) {
              }
            }).find("does not come to its end"),
            std::string::npos);
}

TEST(Rehearsal, BoundsTheMemory) {
  EXPECT_EQ(fault_of([] { std::vector<char>(32 << 20, 'x'); }), "");
  EXPECT_NE(fault_of([] { std::vector<char>(256 << 20, 'x'); }), "");  // the address sanitizer ends the process
}

TEST(Rehearsal, LeavesOtherErrorsToTheReadingItself) {
  EXPECT_EQ(fault_of([] { throw std::runtime_error("another"); }), "");
}

// Addresses of all ones in the heading of a file of h5py: HDF5 1.10 reads them as sizes and comes down.
TEST(Rehearsal, FilesOnWhichHdf5ComesDownAreRefused) {
  const tenon::fem::testing::Scratch scratch;
  const std::string whole = tenon::fem::testing::contents(TENON_SOURCE_DIR "/tests/fuzz/seeds/hdf5/plate_earliest.med");
  int read = 0, came_down = 0;
  for (std::size_t at = 0; at < 1024; at += 8) {
    const auto file = scratch.write("part.med", std::string(whole).replace(at, 8, 8, static_cast<char>(-1)));
    try {
      read += read_med(file).points.size() == 5 ? 1 : 0;
    } catch (const tenon::InputError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("part.med"), std::string::npos);
      came_down += message.find("HDF5 itself fails") != std::string::npos ? 1 : 0;
    }
  }
  EXPECT_GT(read, 0) << "much of the heading says nothing";
  EXPECT_GT(came_down, 0);
}
