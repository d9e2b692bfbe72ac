#include "interfaces/cli/arguments.hpp"

#include <CLI/CLI.hpp>

#include <cmath>
#include <memory>

#include "assembly/integration/simulation.hpp"
#include "interfaces/cli/commands.hpp"

namespace tenon::cli {
namespace {

/// CLI11's own PositiveNumber lets "nan" and "inf" pass.
const CLI::Validator positive(
    [](std::string& word) -> std::string {
      double x = 0.0;
      return CLI::detail::lexical_cast(word, x) && std::isfinite(x) && x > 0.0
                 ? ""
                 : fmt::format("'{}' is no positive number", word);
    },
    "POSITIVE");

void add_info(CLI::App& program, int& status) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App* command = program.add_subcommand("info", "what a mesh or deck holds, and what was read past");
  command->add_option("MESH", options->file, "a mesh (.msh, .inp, .vtu, .vtk, .xdmf, .med) or deck (.bdf, .dat, .inp)")
      ->required();
  command->add_flag("--json", options->json, "one JSON object");
  command->footer("Example: tenon info panel.msh");
  command->callback([options, &status] { status = run(*options); });
}

void add_export(CLI::App& program, int& status) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* command = program.add_subcommand("export", "write a mesh, or the mesh of a deck, in another format");
  command->add_option("MESH", options->input, "a mesh (.msh, .inp, .vtu, .vtk, .xdmf, .med) or deck (.bdf, .dat, .inp)")
      ->required();
  command->add_option("-o,--output", options->output, "a file: .msh (Gmsh 4.1) or .vtu (ParaView)")->required();
  command->add_flag("--binary", options->binary, "of .msh: a binary file");
  command->footer("Example: tenon export panel.bdf -o panel.msh");
  command->callback([options, &status] { status = run(*options); });
}

void add_init(CLI::App& program, int& status) {
  const auto options = std::make_shared<InitOptions>();
  CLI::App* command = program.add_subcommand("init", "write a commented scene for a mesh or deck, to fill in");
  command->add_option("MESH", options->mesh, "a mesh (.msh, .inp, .vtu, .vtk, .xdmf, .med) or deck (.bdf, .dat, .inp)")
      ->required();
  command->add_option("-o,--output", options->output, "a scene; standard output when absent");
  command->footer("Example: tenon init panel.msh -o scene.yaml");
  command->callback([options, &status] { status = run(*options); });
}

void add_check(CLI::App& program, int& status) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* command =
      program.add_subcommand("check", "check a scene, mesh or deck: mass, grounding, singular dofs, elements, ports");
  command->add_option("INPUT", options->input, "a scene (.yaml, .json), a mesh or a Nastran deck")->required();
  command->add_option("--allow", options->allow,
                      "a card of a deck that may be read past although it carries stiffness or mass");
  command->add_flag("--json", options->json, "one JSON object");
  command->footer("Examples: tenon check scene.yaml\n          tenon check panel.msh");
  command->callback([options, &status] { status = run(*options); });
}

void add_modes(CLI::App& program, int& status) {
  const auto options = std::make_shared<ModesOptions>();
  CLI::App* command = program.add_subcommand("modes", "natural frequencies of a scene or of a Nastran deck");
  command->add_option("INPUT", options->file, "a scene (.yaml, .json) or deck (.bdf, .dat, .inp)")->required();
  command->add_option("--count", options->count, "how many modes, rigid ones included")->check(CLI::Range(1, 100000));
  command->add_option("--band", options->band_hz, "instead of --count: all modes between F0 and F1 [Hz]")->expected(2);
  command->add_flag("--full", options->full, "the unreduced FE model, beside the reduced one");
  command->add_option("--clamp", options->clamp, "hold all dofs of a set of a deck, e.g. boundary")->expected(1, -1);
  command->add_option("--allow", options->allow, "a card that may be read past although it carries stiffness or mass");
  command->add_option("--vtu", options->vtu, "write the mode shapes for ParaView");
  command->add_flag("--json", options->json, "one JSON object");
  command->footer(
      "Examples: tenon modes scene.yaml --full --count 12\n          tenon modes part.bdf --clamp boundary");
  command->callback([options, &status] { status = run(*options); });
}

void add_reduce(CLI::App& program, int& status) {
  const auto options = std::make_shared<ReduceOptions>();
  CLI::App* command =
      program.add_subcommand("reduce", "one body of a scene to modes, with certificate and effective mass");
  command->add_option("SCENE", options->scene, "a scene (.yaml, .json)")->required();
  command->add_option("--body", options->body, "which body")->required();
  command->add_option("-o,--output", options->output, "write the reduced body, *.body.json");
  command->add_flag("--linear", options->linear,
                    "leave out what large motion needs (shape integrals, geometric stiffening)");
  command->add_flag("--json", options->json, "one JSON object");
  command->footer("Example: tenon reduce scene.yaml --body panel -o panel.body.json");
  command->callback([options, &status] { status = run(*options); });
}

void add_assemble(CLI::App& program, int& status) {
  const auto options = std::make_shared<AssembleOptions>();
  CLI::App* command = program.add_subcommand("assemble", "the linear system of a scene: modes and state space");
  command->add_option("SCENE", options->scene, "a scene (.yaml, .json)")->required();
  command->add_option("-o,--output", options->output, "write A, B, C, D with named channels as JSON");
  CLI::Option* reactions = command
                               ->add_option("--reactions", options->reactions_hz,
                                            "what joints and ground transmit at this frequency [Hz]; 0: at rest")
                               ->check(CLI::NonNegativeNumber);
  command
      ->add_flag("--linearise", options->linearise,
                 "of the recursive model, about the rest, equilibrium or constant spin that `simulation:` gives")
      ->excludes(reactions);
  command->add_flag("--json", options->json, "one JSON object (without the matrices)");
  command->footer("Example: tenon assemble scene.yaml -o system.json --reactions 0.5");
  command->callback([options, &status] { status = run(*options); });
}

void add_frf(CLI::App& program, int& status) {
  const auto options = std::make_shared<FrfOptions>();
  CLI::App* command = program.add_subcommand("frf", "frequency response of a scene from an input to outputs");
  command->add_option("SCENE", options->scene, "a scene (.yaml, .json)")->required();
  command->add_option("--from", options->from, "an input of the scene")->required();
  command->add_option("--to", options->to, "outputs of the scene; a name without direction takes all of its own")
      ->required()
      ->expected(1, -1);
  command->add_option("--band", options->band_hz, "F0 F1 [Hz]; the scene's required band when absent")->expected(2);
  command->add_option("--points", options->points, "points of the grid, peaks get more")->check(CLI::Range(2, 100000));
  command->add_option("-o,--output", options->output, "write gain and phase as .csv or .json");
  command->add_option("--svg", options->svg, "write a picture");
  command->add_flag("--json", options->json, "one JSON object");
  command->footer("Example: tenon frf scene.yaml --from torque --to rate --svg frf.svg -o frf.csv");
  command->callback([options, &status] { status = run(*options); });
}

void add_sweep(CLI::App& program, int& status) {
  const auto options = std::make_shared<SweepOptions>();
  CLI::App* command = program.add_subcommand("sweep", "modes of a scene against the angle of a joint");
  command->add_option("SCENE", options->scene, "a scene (.yaml, .json)")->required();
  command->add_option("--joint", options->joint, "a revolute joint of the scene")->required();
  command->add_option("--from", options->from, "first angle [deg]; 0 when absent");
  command->add_option("--to", options->to, "last angle [deg]; 360 when absent");
  command->add_option("--steps", options->steps, "points, both ends included")->check(CLI::Range(1, 1000000));
  command->add_option("--modes", options->modes, "flexible modes at each angle")->check(CLI::Range(1, 1000));
  command->add_flag("--hold", options->hold, "the joint is clamped at each angle");
  command->add_option("-o,--output", options->output, "write a table as .csv");
  command->add_option("--svg", options->svg, "write frequencies against the angle as a picture");
  command->add_option("--shapes", options->shapes, "write pictures of the mode shapes, seen along z");
  command->add_option("--at", options->at, "angles of these pictures [deg]; 0 and 180 when absent")->expected(1, -1);
  command->add_flag("--json", options->json, "one JSON object");
  command->footer("Example: tenon sweep fourbar.yaml --joint drive --hold --steps 361 --svg fourbar.svg --modes 3");
  command->callback([options, &status] { status = run(*options); });
}

void add_simulate(CLI::App& program, int& status) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = program.add_subcommand("simulate", "large motion of a scene over time");
  command->add_option("SCENE", options->scene, "a scene (.yaml, .json), perhaps with `simulation:`")->required();
  command->add_option("--time", options->time, "until when [s]")->check(positive);
  command->add_option("--step", options->step, "of methods with fixed steps; the first one of others [s]")
      ->check(positive);
  command
      ->add_option("--tolerance", options->tolerance, "relative, of methods that choose their steps; 1e-6 when absent")
      ->check(positive);
  command->add_option("--method", options->method,
                      fmt::format("{}; generalized-alpha with a step and no tolerance, else bdf (dormand-prince when "
                                  "loops close)",
                                  assembly::method_choice));
  command
      ->add_option("--sample", options->sample,
                   "time between samples [s]; 1000 samples when absent, or as before with --resume")
      ->check(positive);
  command->add_option("--out", options->out, "a folder for history.csv, history.npz, pictures and checkpoint.json");
  command->add_option("--resume", options->resume, "go on from a checkpoint.json");
  command->add_flag("--json", options->json, "one JSON object");
  command->footer("Example: tenon simulate scene.yaml --time 60 --step 0.01 --out run");
  command->callback([options, &status] { status = run(*options); });
}

void add_beam(CLI::App& program, int& status) {
  const auto options = std::make_shared<BeamOptions>();
  CLI::App* command = program.add_subcommand("beam", "analytic against finite-element beams");
  command->add_option("--length", options->length, "of your beam [m]; without a beam: the tables of the TITOP paper")
      ->check(CLI::PositiveNumber);
  command->add_option("--section", options->section,
                      "circle:R, tube:OUTER,INNER, rectangle:B,H (bends along B) or general:A,I [m]");
  command->add_option("--material", options->material, "aluminium, steel or titanium");
  command->add_option("--bc", options->bc, "two ends, e.g. clamped-free: that case alone, with its convergence");
  command->add_option("--modes", options->modes, "fixed-interface modes kept")->check(CLI::Range(1, 24));
  command->add_option("--elements", options->elements, "finite elements")->check(CLI::Range(2, 512));
  command->add_option("--svg", options->svg, "write both convergences as a picture (of the first case without --bc)");
  command->add_flag("--json", options->json, "one JSON object");
  command->footer(
      "Example: tenon beam --length 2 --section tube:0.05,0.046 --material aluminium --bc clamped-free --svg beam.svg");
  command->callback([options, &status] { status = run(*options); });
}

void add_doctor(CLI::App& program, int& status) {
  const auto options = std::make_shared<DoctorOptions>();
  CLI::App* command = program.add_subcommand("doctor", "versions, libraries, BLAS kernel, threads, licence effect");
  command->add_flag("--json", options->json, "one JSON object");
  CLI::Option* costs = command->add_flag(
      "--cost", options->cost, "operations and seconds of forward dynamics, composite against articulated bodies");
  command->add_option("--bodies", options->bodies, "of the chains of --cost")
      ->check(CLI::Range(1, 1000))
      ->needs(costs)
      ->capture_default_str();
  command->add_option("--svg", options->svg, "write the ratios of --cost as a picture")->needs(costs);
  command->add_option("scene", options->scene, "measure its system with --cost, in place of chains")->needs(costs);
  command->footer("Example: tenon doctor --cost --bodies 2 10 100 --svg cost.svg");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace

void add_commands(CLI::App& program, int& status) {
  add_info(program, status);
  add_export(program, status);
  add_init(program, status);
  add_check(program, status);
  add_modes(program, status);
  add_reduce(program, status);
  add_assemble(program, status);
  add_frf(program, status);
  add_sweep(program, status);
  add_simulate(program, status);
  add_beam(program, status);
  add_doctor(program, status);
}

}  // namespace tenon::cli
