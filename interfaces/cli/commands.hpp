#pragma once

#include <CLI/CLI.hpp>

/// One function a command: it adds the command and its options to the program; running it sets `status`.
namespace tenon::cli {

/// A command of the program without options yet. Here alone is a CLI::App made, whose code is long to compile.
CLI::App* add_command(CLI::App& program, const char* name, const char* description);

void add_info(CLI::App& program, int& status);
void add_init(CLI::App& program, int& status);
void add_check(CLI::App& program, int& status);
void add_modes(CLI::App& program, int& status);
void add_reduce(CLI::App& program, int& status);
void add_assemble(CLI::App& program, int& status);
void add_frf(CLI::App& program, int& status);
void add_sweep(CLI::App& program, int& status);
void add_simulate(CLI::App& program, int& status);
void add_beam(CLI::App& program, int& status);
void add_doctor(CLI::App& program, int& status);

}  // namespace tenon::cli
