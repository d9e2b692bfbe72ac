#pragma once

namespace CLI {
class App;
}

/// The options of every command, all in one source: what reads a command line is long to compile.
namespace tenon::cli {

/// Adds the commands to the program; running one sets `status`.
void add_commands(CLI::App& program, int& status);

}  // namespace tenon::cli
