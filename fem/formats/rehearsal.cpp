#include "fem/formats/rehearsal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

#include "fem/formats/vtk/values.hpp"

#if defined(__SANITIZE_ADDRESS__)
#define TENON_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TENON_ADDRESS_SANITIZER
#endif
#endif

namespace tenon::fem {
namespace {

void lower(__rlimit_resource what, rlim_t most) {
  rlimit limit{};
  if (getrlimit(what, &limit) != 0) return;
  limit.rlim_cur = std::min(limit.rlim_cur, most);
  setrlimit(what, &limit);
}

/// Of the process of its own: time, memory, no core left behind, no words of the C library about its end.
void bound_this_process(rlim_t file_bytes) {
  for (const int fatal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(fatal, SIG_DFL);
  const rlim_t seconds = 1 + file_bytes / (2 << 20);
  lower(RLIMIT_CPU, seconds);
  lower(RLIMIT_CORE, 0);
  alarm(static_cast<unsigned>(std::min<rlim_t>(60 * seconds, 100000)));  // one that waits uses no time
  rlim_t pages = 0;
  if (std::ifstream("/proc/self/statm") >> pages)
    lower(RLIMIT_AS, pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (64 << 20) + 100 * file_bytes);
#if !defined(TENON_ADDRESS_SANITIZER)  // whose reports are worth reading
  if (const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) dup2(nowhere, STDERR_FILENO);
#endif
}

void send(int pipe, std::string_view text) {
  while (!text.empty()) {
    const ssize_t n = write(pipe, text.data(), text.size());
    if (n < 0 && errno != EINTR) return;
    text.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
  }
}

std::string receive(int pipe) {
  std::string text;
  std::array<char, 4096> part{};
  for (ssize_t n = 0; (n = read(pipe, part.data(), part.size())) > 0 || (n < 0 && errno == EINTR);)
    text.append(part.data(), static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
  return text;
}

/// Sends what and cure of the fault, parted by a zero, and ends this process.
[[noreturn]] void rehearse_here(int pipe, rlim_t file_bytes, const std::function<void()>& reading) {
  bound_this_process(file_bytes);
  try {
    reading();
  } catch (const vtk::ArrayFault& fault) {
    send(pipe, fault.what + '\0' + fault.cure);
    _exit(1);
  } catch (const std::bad_alloc&) {
    send(pipe, std::string("it asks for more memory than a hundred times the file") + '\0' + "Write it again");
    _exit(1);
  } catch (...) {
    _exit(0);  // whatever else is thrown, is thrown again where it can be caught
  }
  _exit(0);
}

}  // namespace

void rehearse(const std::filesystem::path& file, const std::function<void()>& reading) {
  std::error_code unknown;
  const auto size = std::filesystem::file_size(file, unknown);
  std::array<int, 2> ends{};
  if (unknown || pipe2(ends.data(), O_CLOEXEC) != 0) return;
  const pid_t process = fork();
  if (process == 0) rehearse_here(ends[1], size, reading);
  close(ends[1]);
  const std::string text = process > 0 ? receive(ends[0]) : std::string();
  close(ends[0]);
  if (process < 0) return;
  int status = 0;
  while (waitpid(process, &status, 0) < 0)
    if (errno != EINTR) return;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const char* const again = "Write it again, or let h5repack copy what can be read";
  if (const std::size_t parted = text.find('\0'); parted != std::string::npos)
    throw vtk::ArrayFault{text.substr(0, parted), text.substr(parted + 1)};
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGXCPU || signal == SIGALRM)
    throw vtk::ArrayFault{fmt::format("'{}' is damaged: HDF5 does not come to its end", file.filename().string()),
                          again};
  throw vtk::ArrayFault{fmt::format("'{}' is damaged: HDF5 itself fails on it", file.filename().string()), again};
}

}  // namespace tenon::fem
