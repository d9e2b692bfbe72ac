#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <exception>

#include "fem/error.hpp"
#include "fem/mesh.hpp"
#include "interfaces/cli/arguments.hpp"
#include "interfaces/cli/output.hpp"

namespace {

using namespace tenon;

/// A first word that is no command: say so with the near miss, before the option parser says something vaguer.
bool unknown_command(const CLI::App& program, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return false;
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  const std::string word = argv[1];
  if (std::find(names.begin(), names.end(), word) != names.end()) return false;
  const std::string near = fem::near_miss(word, names);
  fmt::print(
      stderr, "tenon: there is no command '{}'. {}\n", word,
      near.empty() ? fmt::format("There are: {}.", fmt::join(names, ", ")) : fmt::format("Did you mean '{}'?", near));
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program{
      "From FE meshes to models that can be joined: reduced bodies, assembled systems, modes and responses.\n"
      "Exit status: 0 done, 1 computed but a check failed, 2 bad input, 3 a fault of the program.",
      "tenon"};
  program.require_subcommand(1);
  program.set_version_flag("--version", TENON_VERSION);
  int status = cli::done;
  cli::add_commands(program, status);
  if (unknown_command(program, argc, argv)) return cli::bad_input;
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& fault) {
    return program.exit(fault) == 0 ? cli::done : cli::bad_input;
  } catch (const NumericalError& fault) {
    fmt::print(stderr, "tenon: {}\n", fault.what());
    return cli::check_failed;
  } catch (const Error& fault) {
    fmt::print(stderr, "tenon: {}\n", fault.what());
    return cli::bad_input;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "tenon: the model does not fit into memory. Use a coarser mesh or a larger machine.\n");
    return cli::internal_fault;
  } catch (const std::exception& fault) {
    fmt::print(stderr, "tenon: a fault of the program itself: {}. Please report it with the input.\n", fault.what());
    return cli::internal_fault;
  }
  return status;
}
