#include "fem/formats/abaqus.hpp"
#include "tests/unit/broken_files/broken.hpp"

namespace tenon::broken {
namespace {

const std::string whole_deck = R"(*HEADING
a sound deck
*NODE, NSET=ALL
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 2., 0., 0.
*ELEMENT, TYPE=S4, ELSET=SKIN
1, 1, 2, 3, 4
*ELEMENT, TYPE=B31, ELSET=BOOM
2, 2, 5
*ELEMENT, TYPE=MASS, ELSET=TIP
3, 5
*NSET, NSET=ROOT
1, 4
*MATERIAL, NAME=STEEL
*ELASTIC
2.1E11, 0.3
*DENSITY
7800.
*SHELL SECTION, ELSET=SKIN, MATERIAL=STEEL
0.01
*BEAM SECTION, ELSET=BOOM, MATERIAL=STEEL, SECTION=RECT
0.02, 0.03
0., 1., 0.
*MASS, ELSET=TIP
1.5
*EQUATION
2
3, 3, 1., 4, 3, -1.
*BOUNDARY
1, 1, 6
)";

/// Lines from 16 on, behind five nodes, a material and a sectioned shell; nothing of elements 11 and above.
Case lines(const std::string& name, const std::string& text, std::vector<std::string> says,
           std::optional<std::pair<long, long>> place = {}) {
  return {name,
          "*NODE, NSET=ALL\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 2, 0, 0\n*ELEMENT, TYPE=S4, ELSET=SKIN\n"
          "1, 1, 2, 3, 4\n*MATERIAL, NAME=M\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n"
          "*SHELL SECTION, ELSET=SKIN, MATERIAL=M\n0.01\n" +
              text,
          std::move(says), place};
}

const std::string boom = "*ELEMENT, TYPE=B31, ELSET=BOOM\n11, 2, 5\n";       // lines 16, 17
const std::string lump = "*ELEMENT, TYPE=MASS, ELSET=TIP\n11, 5\n";          // lines 16, 17
const std::string bar = "*ELEMENT, TYPE=T3D2, ELSET=BAR\n11, 2, 5\n";        // lines 16, 17
const std::string bolt = "*ELEMENT, TYPE=SPRING2, ELSET=BOLT\n11, 2, 5\n";   // lines 16, 17
const std::string along = "*ELEMENT, TYPE=SPRINGA, ELSET=BOLT\n11, 2, 5\n";  // lines 16, 17
const std::string beam_section = "*BEAM SECTION, ELSET=BOOM, MATERIAL=M, SECTION=";

std::vector<Case> mesh_cases() {
  return {
      lines("node twice at two places", "*NODE\n5, 3, 0, 0\n", {"node 5 is defined a second time"}, {{17, 1}}),
      lines("node numbered 0", "*NODE\n0, 3, 0, 0\n", {"'0'", "above zero"}, {{17, 1}}),
      lines("node of a negative number", "*NODE\n-7, 3, 0, 0\n", {"'-7'", "above zero"}, {{17, 1}}),
      lines("node number too large", "*NODE\n99999999999999999999, 3, 0, 0\n", {"a whole number"}, {{17, 1}}),
      lines("node number with a point", "*NODE\n7., 3, 0, 0\n", {"'7.'", "a whole number"}, {{17, 1}}),
      lines("node at nan", "*NODE\n7, 0, nan, 0\n", {"'nan'", "expected y"}, {{17, 7}}),
      lines("node at infinity", "*NODE\n7, 0, 0, -inf\n", {"'-inf'", "expected z"}, {{17, 10}}),
      lines("node that overflows", "*NODE\n7, 1e999, 0, 0\n", {"'1e999'", "expected x"}, {{17, 4}}),
      lines("numbers with decimal commas parted by semicolons", "*NODE\n7; 1,5; 0; 0\n", {"'7; 1'"}, {{17, 1}}),
      lines("numbers parted by blanks alone", "*NODE\n7 1.5 0 0\n", {"'7 1.5 0 0'"}, {{17, 1}}),
      lines("nodes in cylindrical coordinates", "*NODE, SYSTEM=C\n7, 1, 90, 0\n", {"cylindrical"}, {{16, 0}}),
      lines("node set without a name", "*NODE, NSET=\n7, 1, 0, 0\n", {"NSET", "name"}, {{16, 0}}),
      lines("element without a type", "*ELEMENT, ELSET=X\n11, 1, 2\n", {"has no TYPE"}, {{16, 0}}),
      lines("element of an unknown type", "*ELEMENT, TYPE=S44X9, ELSET=X\n11, 1, 2, 3, 4\n", {"S44X9"}, {{16, 0}}),
      lines("element numbered 0", "*ELEMENT, TYPE=B31\n0, 1, 2\n", {"'0'", "above zero"}, {{17, 1}}),
      lines("element twice", "*ELEMENT, TYPE=B31\n1, 1, 2\n", {"element 1 is defined a second time"}, {{17, 1}}),
      lines("element on an unknown node", "*ELEMENT, TYPE=B31\n11, 1, 99\n", {"node 99 is not defined"}, {{17, 8}}),
      lines("element with a word for a node", "*ELEMENT, TYPE=B31\n11, 1, two\n", {"'two'"}, {{17, 8}}),
      lines("element cut short", "*ELEMENT, TYPE=S4\n11, 1, 2, 3\n", {"has 3 nodes, expected 4"}, {{17, 1}}),
      lines("element with a node too many", "*ELEMENT, TYPE=S3\n11, 1, 2, 3, 4\n", {"has 4 nodes, expected 3"},
            {{17, 1}}),
      lines("element that runs into the next", "*ELEMENT, TYPE=S4\n11, 1, 2,\n12, 1, 2, 3, 4\n", {"node 12"},
            {{18, 1}}),
      lines("element set without a name", "*ELEMENT, TYPE=B31, ELSET=\n11, 1, 2\n", {"ELSET", "name"}, {{16, 0}}),
      lines("set without a name", "*NSET\n1, 2\n", {"*NSET has no name"}, {{16, 0}}),
      lines("set of an unknown node", "*NSET, NSET=A\n1, 99\n", {"names node 99, which is not defined"}, {{17, 4}}),
      lines("set of an unknown element", "*ELSET, ELSET=A\n1, 99\n", {"names element 99"}, {{17, 4}}),
      lines("set of an unknown set", "*NSET, NSET=A\nALLL\n", {"there is no node set 'ALLL'", "'ALL'"}, {{17, 1}}),
      lines("set of itself alone", "*NSET, NSET=A\nA\n", {"there is no node set 'A'"}, {{17, 1}}),
      lines("element set of a node set", "*ELSET, ELSET=A\nALL\n", {"there is no element set 'ALL'"}, {{17, 1}}),
      lines("nodes of an unknown element set", "*NSET, NSET=A, ELSET=B\n", {"there is no element set 'B'"}, {{16, 0}}),
      lines("range turned around", "*NSET, NSET=A, GENERATE\n4, 1, 1\n", {"a rising range"}, {{17, 4}}),
      lines("range with step 0", "*NSET, NSET=A, GENERATE\n1, 4, 0\n", {"a step above zero"}, {{17, 4}}),
      lines("range with a falling step", "*NSET, NSET=A, GENERATE\n1, 4, -1\n", {"a step above zero"}, {{17, 4}}),
      lines("range without an end", "*NSET, NSET=A, GENERATE\n1\n", {"found nothing", "the last number"}, {{17, 0}}),
      lines("range of words", "*NSET, NSET=A, GENERATE\nA, B\n", {"'A'", "the first number"}, {{17, 1}}),
      lines("range over all whole numbers", "*NSET, NSET=A, GENERATE\n-9223372036854775808, 9223372036854775807, 1\n",
            {"above zero"}, {{17, 1}}),
  };
}

std::vector<Case> section_cases() {
  return {
      lines("material without a name", "*MATERIAL\n*ELASTIC\n1, 0\n", {"*MATERIAL has no NAME"}, {{16, 0}}),
      lines("material twice", "*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0\n", {"material 'm' stands already", "bad.inp:9"},
            {{16, 0}}),
      lines("moduli twice in a material", "*MATERIAL, NAME=N\n*ELASTIC\n1e9, 0\n*ELASTIC\n2e9, 0\n",
            {"*ELASTIC", "second"}, {{19, 0}}),
      lines("density twice in a material", "*MATERIAL, NAME=N\n*DENSITY\n1\n*DENSITY\n2\n", {"*DENSITY", "second"},
            {{19, 0}}),
      lines("moduli of two temperatures",
            "*MATERIAL, NAME=N\n*ELASTIC\n2e9, 0.3, 20\n1e9, 0.3, 400\n*ELEMENT, TYPE=S3, ELSET=T\n11, 1, 2, 3\n"
            "*SHELL SECTION, ELSET=T, MATERIAL=N\n0.01\n",
            {"*MATERIAL N (1 found", "varies with temperature"}, {{22, 0}}),
      lines("density of two temperatures",
            "*MATERIAL, NAME=N\n*ELASTIC\n2e9, 0.3\n*DENSITY\n2, 20\n1, 400\n*ELEMENT, TYPE=S3, ELSET=T\n11, 1, 2, 3\n"
            "*SHELL SECTION, ELSET=T, MATERIAL=N\n0.01\n",
            {"*MATERIAL N (1 found", "varies with temperature"}, {{24, 0}}),
      lines("modulus of the second temperature", "*MATERIAL, NAME=N\n*ELASTIC\n1e9, 0.3, 20\nhot, 0.3, 400\n",
            {"'hot'"}, {{19, 1}}),
      lines("modulus of zero", "*MATERIAL, NAME=N\n*ELASTIC\n0, 0.3\n", {"'0'", "Young's modulus"}, {{18, 1}}),
      lines("modulus that is nan", "*MATERIAL, NAME=N\n*ELASTIC\nNaN, 0.3\n", {"'NaN'"}, {{18, 1}}),
      lines("Poisson's ratio above a half", "*MATERIAL, NAME=N\n*ELASTIC\n1e9, 0.51\n", {"Poisson's ratio"}, {{18, 6}}),
      lines("Poisson's ratio of -1", "*MATERIAL, NAME=N\n*ELASTIC\n1e9, -1\n", {"Poisson's ratio"}, {{18, 6}}),
      lines("density below zero", "*MATERIAL, NAME=N\n*DENSITY\n-7800\n", {"not negative"}, {{18, 1}}),
      lines("density of nothing", "*MATERIAL, NAME=N\n*DENSITY\n", {"*DENSITY has no data line"}, {{17, 0}}),
      lines("section without a set", "*SHELL SECTION, MATERIAL=M\n0.01\n", {"has no ELSET"}, {{16, 0}}),
      lines("section of an unknown set", "*SHELL SECTION, ELSET=SKINS, MATERIAL=M\n0.01\n", {"Did you mean 'SKIN'"},
            {{16, 0}}),
      lines("section of no material", "*SHELL SECTION, ELSET=SKIN\n0.01\n", {"names no material"}, {{16, 0}}),
      lines("section of an unknown material", "*SHELL SECTION, ELSET=SKIN, MATERIAL=MM\n0.01\n",
            {"there is no material 'MM'"}, {{16, 0}}),
      lines("section of a material without moduli",
            "*MATERIAL, NAME=EMPTY\n*SHELL SECTION, ELSET=SKIN, MATERIAL=EMPTY\n0.01\n", {"has no *ELASTIC"},
            {{17, 0}}),
      lines("section of elements that have one", "*SHELL SECTION, ELSET=SKIN, MATERIAL=M\n0.02\n",
            {"element 1 has a section already", "bad.inp:14"}, {{16, 0}}),
      lines("shell section without a thickness",
            "*ELEMENT, TYPE=S3, ELSET=T\n11, 1, 2, 3\n*SHELL SECTION, ELSET=T, "
            "MATERIAL=M\n",
            {"has no data line"}, {{18, 0}}),
      lines("shell of negative thickness",
            "*ELEMENT, TYPE=S3, ELSET=T\n11, 1, 2, 3\n*SHELL SECTION, ELSET=T, "
            "MATERIAL=M\n-0.01\n",
            {"'-0.01'", "the thickness"}, {{19, 1}}),
      lines("shell off its nodes",
            "*ELEMENT, TYPE=S3, ELSET=T\n11, 1, 2, 3\n*SHELL SECTION, ELSET=T, MATERIAL=M, "
            "OFFSET=0.5\n0.01\n",
            {"OFFSET=0.5, by which Abaqus moves"}, {{18, 0}}),
      lines("shell with a mass of its own",
            "*ELEMENT, TYPE=S3, ELSET=T\n11, 1, 2, 3\n*SHELL SECTION, ELSET=T, MATERIAL=M, DENSITY=5\n0.01\n",
            {"*SHELL SECTION, DENSITY (1 found", "is not read"}, {{18, 0}}),
      lines("shell with a misspelt offset",
            "*ELEMENT, TYPE=S3, ELSET=T\n11, 1, 2, 3\n*SHELL SECTION, ELSET=T, MATERIAL=M, OFSET=5\n0.01\n",
            {"*SHELL SECTION, OFSET (1 found", "is not read"}, {{18, 0}}),
      lines("shell of two materials",
            "*ELEMENT, TYPE=S3, ELSET=T\n11, 1, 2, 3\n*SHELL SECTION, ELSET=T, MATERIAL=M, material=M\n0.01\n",
            {"*SHELL SECTION gives MATERIAL twice"}, {{18, 0}}),
      lines("beam off its nodes",
            boom + "*BEAM SECTION, ELSET=BOOM, MATERIAL=M, SECTION=RECT, OFFSET1=0.5\n.1, .1\n0, 1, 0\n",
            {"*BEAM SECTION, OFFSET1 (1 found"}, {{18, 0}}),
      lines("mass of three directions", lump + "*MASS, ELSET=TIP, TYPE=ANISOTROPIC\n1, 2, 3\n",
            {"*MASS, TYPE (1 found"}, {{18, 0}}),
      lines("shell section of beams", boom + "*SHELL SECTION, ELSET=BOOM, MATERIAL=M\n0.01\n", {"takes no *SHELL"},
            {{18, 0}}),
      lines("beams without a section", boom, {"B31 without a section", "element 11"}, {{16, 0}}),
      lines("beam section without a shape", boom + "*BEAM SECTION, ELSET=BOOM, MATERIAL=M\n0.1, 0.1\n",
            {"without SECTION"}, {{18, 0}}),
      lines("beam section of an unknown shape", boom + beam_section + "STAR\n0.1, 0.1\n0, 1, 0\n", {"SECTION=STAR"},
            {{18, 0}}),
      lines("beam section without sizes", boom + beam_section + "RECT\n", {"has no data line"}, {{18, 0}}),
      lines("rectangle of no side", boom + beam_section + "RECT\n, 0.1\n0, 1, 0\n", {"found nothing, expected a"},
            {{19, 0}}),
      lines("rectangle of a side of zero", boom + beam_section + "RECT\n0.1, 0\n0, 1, 0\n", {"'0'", "expected b"},
            {{19, 6}}),
      lines("pipe thicker than its radius", boom + beam_section + "PIPE\n0.1, 0.2\n0, 1, 0\n", {"'0.2'", "a wall"},
            {{19, 6}}),
      lines("box of walls that meet", boom + beam_section + "BOX\n0.1, 0.1, 0.05, 0.05, 0.05, 0.05\n0, 1, 0\n",
            {"walls thinner"}, {{19, 11}}),
      lines("I lower than its flanges", boom + beam_section + "I\n0, 0.1, 0.1, 0.1, 0.05, 0.05, 0.01\n0, 1, 0\n",
            {"above both flanges"}, {{19, 4}}),
      lines("beam along n1", boom + beam_section + "RECT\n0.1, 0.1\n1, 0, 0\n", {"element 11", "lies along it"},
            {{18, 0}}),
      lines("n1 of no length", boom + beam_section + "RECT\n0.1, 0.1\n0, 0, 0\n", {"'0'", "some length"}, {{20, 1}}),
      lines("n1 of words", boom + beam_section + "RECT\n0.1, 0.1\n0, up, 0\n", {"'up'"}, {{20, 4}}),
      lines("beam of no length",
            "*ELEMENT, TYPE=B31, ELSET=BOOM\n11, 2, 2\n" + beam_section + "RECT\n0.1, 0.1\n0, 1, 0\n",
            {"element 11 has no length"}, {{18, 0}}),
      lines("general section without moduli", boom + "*BEAM GENERAL SECTION, ELSET=BOOM\n1, 1, 0, 1, 1\n0, 1, 0\n",
            {"no line with E and G"}, {{18, 0}}),
      lines("general section of a word for a density",
            boom + "*BEAM GENERAL SECTION, ELSET=BOOM, DENSITY=heavy\n1, 1, 0, 1, 1\n0, 1, 0\n1, 1\n",
            {"DENSITY is 'heavy'"}, {{18, 0}}),
      lines("mass without a number", lump + "*MASS, ELSET=TIP\n", {"has no data line"}, {{18, 0}}),
      lines("mass below zero", lump + "*MASS, ELSET=TIP\n-1\n", {"not negative"}, {{19, 1}}),
      lines("mass that is infinite", lump + "*MASS, ELSET=TIP\ninf\n", {"'inf'"}, {{19, 1}}),
      lines("mass of shells", "*MASS, ELSET=SKIN\n1\n", {"has a section already"}, {{16, 0}}),
      lines("masses without *MASS", lump, {"MASS without a section"}, {{16, 0}}),
      lines("inertia of two numbers", "*ELEMENT, TYPE=ROTARYI, ELSET=R\n11, 5\n*ROTARY INERTIA, ELSET=R\n1, 1\n",
            {"expected I33"}, {{19, 0}}),
      lines("products of inertia", "*ELEMENT, TYPE=ROTARYI, ELSET=R\n11, 5\n*ROTARY INERTIA, ELSET=R\n1, 1, 1, .1\n",
            {"products of inertia"}, {{18, 0}}),
      lines("rod of negative area", bar + "*SOLID SECTION, ELSET=BAR, MATERIAL=M\n-1\n", {"'-1'", "the area"},
            {{19, 1}}),
      lines("rod of no length", "*ELEMENT, TYPE=T3D2, ELSET=BAR\n11, 2, 2\n*SOLID SECTION, ELSET=BAR, MATERIAL=M\n1\n",
            {"element 11 has no length"}, {{18, 0}}),
      lines("solids", "*ELEMENT, TYPE=C3D4, ELSET=B\n11, 1, 2, 3, 5\n*SOLID SECTION, ELSET=B, MATERIAL=M\n",
            {"C3D4 (1 found, first at", "change stiffness or mass"}, {{18, 0}}),
      lines("spring without a stiffness", bolt + "*SPRING, ELSET=BOLT\n1, 1\n", {"a line with the stiffness"},
            {{18, 0}}),
      lines("spring in dof 7", bolt + "*SPRING, ELSET=BOLT\n7, 7\n1e3\n", {"dof is 7"}, {{18, 0}}),
      lines("spring of negative stiffness", bolt + "*SPRING, ELSET=BOLT\n1, 1\n-1e3\n", {"not negative"}, {{20, 1}}),
      lines("spring that softens", along + "*SPRING, ELSET=BOLT, NONLINEAR\n\n0, 0\n1, 1\n", {"is not read"},
            {{18, 0}}),
      lines("spring along no line", "*ELEMENT, TYPE=SPRINGA, ELSET=BOLT\n11, 2, 2\n*SPRING, ELSET=BOLT\n\n1e3\n",
            {"element 11 has no length"}, {{18, 0}}),
      lines("spring in unknown axes", bolt + "*SPRING, ELSET=BOLT, ORIENTATION=O\n1, 1\n1e3\n",
            {"there is no orientation 'O'"}, {{18, 0}}),
      lines("axes on one line",
            "*ORIENTATION, NAME=O\n1, 0, 0, 2, 0, 0\n" + bolt + "*SPRING, ELSET=BOLT, ORIENTATION=O\n1, 1\n1e3\n",
            {"lie on one line"}, {{17, 1}}),
      lines(
          "axes turned about axis 4",
          "*ORIENTATION, NAME=O\n1, 0, 0, 0, 1, 0\n4, 30\n" + bolt + "*SPRING, ELSET=BOLT, ORIENTATION=O\n1, 1\n1e3\n",
          {"'4'", "an axis 1 to 3"}, {{18, 1}}),
  };
}

std::vector<Case> link_cases() {
  const std::string sides = "*SURFACE, NAME=S, TYPE=NODE\n3\n4\n";  // lines 16 to 18
  return {
      lines("rigid body without a reference", "*RIGID BODY, NSET=ALL\n", {"has no REF NODE"}, {{16, 0}}),
      lines("rigid body about an unknown node", "*RIGID BODY, NSET=ALL, REF NODE=99\n", {"node 99 is not defined"},
            {{16, 0}}),
      lines("rigid body about a set of many", "*RIGID BODY, NSET=ALL, REF NODE=ALL\n", {"has 5 nodes"}, {{16, 0}}),
      lines("rigid body of an unknown set", "*RIGID BODY, NSET=NONE, REF NODE=1\n", {"there is no node set 'NONE'"},
            {{16, 0}}),
      lines("rigid body of nothing", "*RIGID BODY, REF NODE=1\n", {"*RIGID BODY", "nodes"}, {{16, 0}}),
      lines("rigid body of its reference alone", "*NSET, NSET=A\n1\n*RIGID BODY, NSET=A, REF NODE=1\n",
            {"*RIGID BODY", "nodes"}, {{18, 0}}),
      lines("coupling of an unknown surface", "*COUPLING, REF NODE=1, SURFACE=S\n*KINEMATIC\n",
            {"there is no surface 'S'"}, {{16, 0}}),
      lines("coupling without its kind", sides + "*COUPLING, REF NODE=1, SURFACE=S\n", {"neither *KINEMATIC"},
            {{19, 0}}),
      lines("kind without its coupling", "*KINEMATIC\n1, 3\n", {"*KINEMATIC", "*COUPLING"}, {{16, 0}}),
      lines("coupling cut off from its kind",
            sides + "*COUPLING, REF NODE=1, SURFACE=S\n*NSET, NSET=A\n1\n*KINEMATIC\n", {"neither *KINEMATIC"},
            {{19, 0}}),
      lines("coupling in dof 7", sides + "*COUPLING, REF NODE=1, SURFACE=S\n*KINEMATIC\n1, 7\n", {"dofs from 1 to 6"},
            {{21, 1}}),
      lines("coupling in turned axes", sides + "*COUPLING, REF NODE=1, SURFACE=S, ORIENTATION=O\n*KINEMATIC\n",
            {"own axes"}, {{19, 0}}),
      lines("coupling to its reference alone",
            "*SURFACE, NAME=S, TYPE=NODE\n1\n*COUPLING, REF NODE=1, SURFACE=S\n*KINEMATIC\n", {"no other node"},
            {{18, 0}}),
      lines("surface of an edge", "*SURFACE, NAME=S\nSKIN, E1\n*COUPLING, REF NODE=5, SURFACE=S\n*KINEMATIC\n",
            {"side E1"}, {{17, 7}}),
      lines("surface twice", sides + "*SURFACE, NAME=s, TYPE=NODE\n2\n*COUPLING, REF NODE=1, SURFACE=S\n*KINEMATIC\n",
            {"surface 's'", "bad.inp:16"}, {{19, 0}}),
      lines("constraint of an unknown kind", "*MPC\nELBOW, 1, 2\n", {"*MPC ELBOW"}, {{17, 1}}),
      lines("constraint of an unknown node", "*MPC\nBEAM, 1, 99\n", {"node 99 is not defined"}, {{17, 10}}),
      lines("constraint of one node", "*MPC\nBEAM, 1\n", {"found nothing"}, {{17, 0}}),
      lines("constraint of sets of two sizes", "*NSET, NSET=A\n1, 2\n*MPC\nBEAM, ALL, A\n", {"5 nodes with 2"},
            {{19, 7}}),
      lines("equation of no term", "*EQUATION\n0\n", {"'0'", "at least one term"}, {{17, 1}}),
      lines("equation that is cut", "*EQUATION\n3\n1, 1, 1., 2, 1, -1.\n", {"after 2 of 3 terms"}, {{16, 0}}),
      lines("equation of more terms than the file holds", "*EQUATION\n9223372036854775807\n1, 1, 1.\n",
            {"after 1 of 9223372036854775807"}, {{16, 0}}),
      lines("equation in dof 9", "*EQUATION\n2\n1, 9, 1., 2, 1, -1.\n", {"'9'", "a dof from 1 to 6"}, {{18, 4}}),
      lines("equation with a word", "*EQUATION\n2\n1, 1, one, 2, 1, -1.\n", {"'one'"}, {{18, 7}}),
      lines("equation on an unknown node", "*EQUATION\n2\n99, 1, 1., 2, 1, -1.\n", {"node 99"}, {{18, 1}}),
      lines("support of an unknown node", "*BOUNDARY\n99, 1, 3\n", {"node 99 is not defined"}, {{17, 1}}),
      lines("support of an unknown set", "*BOUNDARY\nROOT, 1, 3\n", {"there is no node set 'ROOT'"}, {{17, 1}}),
      lines("support in dof 0", "*BOUNDARY\n1, 0, 3\n", {"'0'", "dofs from 1 to 6"}, {{17, 4}}),
      lines("support of dofs turned around", "*BOUNDARY\n1, 3, 1\n", {"'3'", "dofs from 1 to 6"}, {{17, 4}}),
      lines("support of an unknown kind", "*BOUNDARY\n1, CLAMPED\n", {"'CLAMPED'"}, {{17, 4}}),
      lines("support moved by a word", "*BOUNDARY\n1, 1, 1, far\n", {"'far'"}, {{17, 10}}),
      lines("frame of an unknown set", "*TRANSFORM, NSET=A\n1, 0, 0, 0, 1, 0\n", {"there is no node set 'A'"},
            {{16, 0}}),
      lines("frame of two points on one line", "*TRANSFORM, NSET=ALL\n1, 0, 0, 2, 0, 0\n", {"lie on one line"},
            {{17, 1}}),
      lines("frame of one point", "*TRANSFORM, NSET=ALL\n1, 0, 0\n", {"found nothing"}, {{17, 0}}),
      lines("frame about no axis", "*TRANSFORM, NSET=ALL, TYPE=C\n0, 5, 0, 0, 5, 0\n", {"axis"}, {{17, 1}}),
      lines("frame of a node on its axis", "*TRANSFORM, NSET=ALL, TYPE=C\n0, 0, 0, 0, 0, 1\n",
            {"a node lies on the axis"}, {{17, 1}}),
      lines("frame on a sphere", "*TRANSFORM, NSET=ALL, TYPE=S\n0, 0, 0, 0, 0, 1\n", {"type S is not read"}, {{16, 0}}),
      lines("unknown keyword", "*FANCY\n", {"*FANCY", "not known here"}, {{16, 0}}),
      lines("keyword with a typing error", "*BUONDARY\n1, 1, 6\n", {"*BUONDARY", "not known here"}, {{16, 0}}),
      lines("parts that are tied", "*TIE, NAME=T\nA, B\n", {"*TIE"}, {{16, 0}}),
      lines("range beyond the nodes", "*NSET, NSET=N, GENERATE\n9223372036854775806, 9223372036854775807, 1\n",
            {"holds no node"}, {{17, 1}}),
      lines("shortened parameter", "*NSET, NSET=N, GEN\n1, 4\n", {"a parameter GEN, which is not read"}, {{16, 0}}),
      lines("equations of another file", "*EQUATION, INPUT=eq.txt\n", {"INPUT= of another file"}, {{16, 0}}),
      lines("reference misspelt", "*RIGID BODY, REF NODE=1, NSET=ALL, ROTNOD=2\n", {"*RIGID BODY, ROTNOD"}, {{16, 0}}),
      lines("stiffness that depends on the rate", "*VISCOELASTIC, TIME=PRONY\n.1,.1,.5\n",
            {"*VISCOELASTIC (1 found", "carry stiffness or mass"}, {{16, 0}}),
      lines("nodes made by rule", "*NGEN\n1, 9, 1\n", {"*NGEN makes parts of the deck by rule"}, {{16, 0}}),
      lines("part that is not defined", "*INSTANCE, NAME=A, PART=P\n*END INSTANCE\n", {"there is no part 'P'"},
            {{16, 0}}),
      lines("part that is not placed", "*PART, NAME=P\n*END PART\n", {"is placed by no *INSTANCE"}, {{16, 0}}),
      lines("instance named twice",
            "*PART, NAME=P\n*END PART\n*INSTANCE, NAME=A, PART=P\n*END INSTANCE\n*INSTANCE, NAME=A, PART=P\n",
            {"instance 'A' is a second one"}, {{20, 0}}),
      lines("instance about no axis",
            "*PART, NAME=P\n*END PART\n*INSTANCE, NAME=A, PART=P\n0.,0.,0.\n1.,0.,0.,1.,0.,0.,30.\n*END INSTANCE\n",
            {"they fix no axis"}, {{20, 1}}),
      lines("springs that would have to turn",
            "*PART, NAME=P\n*SPRING, ELSET=E\n1\n1.\n*END PART\n*INSTANCE, NAME=A, "
            "PART=P\n0.,0.,0.\n0.,0.,0.,1.,0.,0.,30.\n"
            "*END INSTANCE\n",
            {"*SPRING in a part of which an instance is turned is not read"}, {{17, 0}}),
      lines("star without a keyword", "*\n", {"a * without a keyword"}, {{16, 0}}),
  };
}

std::vector<Case> text_cases() {
  std::string wide;
  for (const char c : whole_deck) wide += {c, '\0'};
  std::vector<Case> cases{
      {"empty", "", {"the file is empty"}},
      {"blank lines alone", "\n\n  \n", {"holds no keyword"}},
      {"comments alone", "** nothing\n** here\n", {"holds no keyword"}},
      {"numbers before any keyword", "1, 2, 3\n", {"before any keyword"}, {{1, 1}}},
      {"a heading alone", "*HEADING\nnothing\n", {"defines no node"}},
      {"a block of nodes that is empty", "*NODE\n*ELEMENT, TYPE=B31\n", {"defines no node"}},
      {"UTF-16", "\xFF\xFE" + wide, {"expected text"}, {{1, 0}}},
      {"zero byte", replaced(whole_deck, "3, 1., 1.", std::string("3, 1.,\0", 7)), {"0x00", "expected text"}, {{6, 0}}},
      {"moduli of no material", "*NODE\n1, 0, 0, 0\n*ELASTIC\n1, 0\n", {"*ELASTIC stands under no"}, {{3, 0}}},
      {"include without a name", "*NODE\n1, 0, 0, 0\n*INCLUDE\n", {"names no file"}, {{3, 0}}},
      {"include of no file", "*NODE\n1, 0, 0, 0\n*INCLUDE, INPUT=none.inp\n", {"none.inp", "does not exist"}, {{3, 0}}},
      {"include of a folder", "*NODE\n1, 0, 0, 0\n*INCLUDE, INPUT=.\n", {"is no file"}, {{3, 0}}},
      {"include of itself", "*NODE\n1, 0, 0, 0\n*INCLUDE, INPUT=bad.inp\n", {"includes itself"}, {{3, 0}}},
  };
  Case ring{"two files include each other", "*INCLUDE, INPUT=other.inp\n", {"other.inp:1", "includes itself"}};
  ring.beside = {{"other.inp", "*INCLUDE, INPUT=bad.inp\n"}};
  Case inside{"fault in an included file", "*NODE\n1, 0, 0, 0\n*INCLUDE, INPUT=part.inp\n", {"part.inp:3:4", "'oops'"}};
  inside.beside = {{"part.inp", "** one node\n\n2, oops, 0, 0\n"}};
  Case nothing{"included file that is empty", "*NODE\n*INCLUDE, INPUT=nil.inp\n", {"nil.inp", "the file is empty"}};
  nothing.beside = {{"nil.inp", ""}};
  for (Case& c : std::vector<Case>{ring, inside, nothing}) cases.push_back(std::move(c));

  const auto odd = [&](const char* name, const std::string& bytes) {
    cases.push_back({.name = name, .bytes = bytes, .reads = true});
  };
  odd("Windows line ends", with_windows_ends(whole_deck));
  odd("tabs", replaced(whole_deck, "3, 1., 1., 0.", "\t3,\t1.,\t1.,\t0."));
  odd("lower case", replaced(whole_deck, "*ELEMENT, TYPE=S4, ELSET=SKIN", "*element, type=s4, elset=skin"));
  odd("Latin-1 in a comment", "** Fl\xFCgel\n" + whole_deck);
  odd("UTF-8 byte order mark", "\xEF\xBB\xBF" + whole_deck);
  odd("empty lines", replaced(whole_deck, "3, 1., 1., 0.", "\n\n  \n3, 1., 1., 0."));
  odd("comment between data", replaced(whole_deck, "3, 1., 1., 0.", "** the third\n3, 1., 1., 0."));
  odd("keyword that goes on", replaced(whole_deck, "*SHELL SECTION, ", "*SHELL SECTION,\n  "));
  odd("no line end at the end", whole_deck.substr(0, whole_deck.size() - 1));
  odd("Fortran's exponent", replaced(whole_deck, "2.1E11", "2.1D+11"));
  odd("identical node again", replaced(whole_deck, "*NSET", "*NODE\n5, 2., 0., 0.\n*NSET"));
  odd("range up to the largest number",
      replaced(whole_deck, "*NSET, NSET=ROOT\n1, 4", "*NSET, NSET=ROOT, GENERATE\n1, 4, 3\n4, 9223372036854775807, 1"));
  odd("set that is empty", replaced(whole_deck, "*MATERIAL", "*ELSET, ELSET=NIL\n*MATERIAL"));
  odd("block of elements that is empty", replaced(whole_deck, "*MATERIAL", "*ELEMENT, TYPE=S4\n*MATERIAL"));
  odd("one modulus at two temperatures",
      replaced(whole_deck, "2.1E11, 0.3\n", "2.1E11, 0.3, 20.\n2.1E11, 0.3, 400.\n"));
  odd("support that is empty", replaced(whole_deck, "*BOUNDARY\n1, 1, 6\n", "*BOUNDARY\n"));
  return cases;
}

/// Whether what ends with this line is a mesh, whose sections come from elsewhere, or a deck: no keyword lacks its
/// data, and no section stands without those of the other elements.
bool whole_at(long line) { return line >= 4 && line != 18 && line != 20 && (line < 22 || line > 27) && line != 30; }

}  // namespace

Family abaqus_cases() {
  Family family{"bad.inp", [](const std::filesystem::path& file) { fem::read_abaqus(file); }, {}};
  family.cases.push_back({.name = "sound", .bytes = whole_deck, .reads = true});
  add_words_for_numbers(family.cases, "deck", whole_deck, numbers_of(whole_deck, ","));
  std::vector<Case> cuts;
  add_cuts(cuts, "deck", whole_deck, 0);
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    cuts[k].reads = whole_at(static_cast<long>(k) + 1);
    family.cases.push_back(cuts[k]);
  }
  for (const auto& part : {mesh_cases(), section_cases(), link_cases(), text_cases()})
    family.cases.insert(family.cases.end(), part.begin(), part.end());
  return family;
}

}  // namespace tenon::broken
