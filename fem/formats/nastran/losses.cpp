#include <algorithm>
#include <array>
#include <string_view>

#include "fem/formats/nastran/draft.hpp"

namespace tenon::fem::nastran {
namespace {

/// Cards that say nothing about stiffness or mass, with what they are for. A name that ends in '*' stands for all that
/// begin so.
struct Harmless {
  std::string_view names;
  std::string_view note;
};

constexpr std::array<Harmless, 14> harmless{{
    {"EIGR EIGRL EIGB EIGC EIGP", "how Nastran would solve: the program has its own options"},
    {"FORCE FORCE1 FORCE2 MOMENT MOMENT1 MOMENT2 GRAV ACCEL ACCEL1 LOAD PLOAD PLOAD1 PLOAD2 PLOAD4 PLOADX1 RFORCE "
     "SLOAD "
     "SPCD DEFORM TEMP TEMPD TEMPRB TEMPP1 TEMPF LSEQ DAREA DLOAD DELAY DPHASE TLOAD1 TLOAD2 RLOAD1 RLOAD2 ACSRCE "
     "RANDPS RANDT1 TIC",
     "loads are no part of K and M"},
    {"TABLED* TABLEM* TABLES1 TABLEST TABRND* TABDMP1 MATT* MATS1 CREEP", "tables and what depends on them"},
    {"FREQ FREQ1 FREQ2 FREQ3 FREQ4 FREQ5 TSTEP TSTEPNL NLPARM NLPCI NLSTEP RCROSS",
     "steps of a solution that is not run here"},
    {"CDAMP* PDAMP PDAMP5 PDAMPT CVISC PVISC", "dampers are no part of K and M"},
    {"PBUSHT PELAST",
     "tables of springs over frequency or force: their nominal stiffness counts, as in Nastran's modes"},
    {"SUPORT SUPORT1 SUPAX", "the rigid motions are found without being named"},
    {"CSET CSET1 OMIT OMIT1 USET USET1 SESET",
     "a partition of the dofs for Nastran's own reduction: the frequencies here are those of all dofs"},
    {"PLOTEL PLOTEL3 PLOTEL4 SET1 SET3 GROUP ECHOON ECHOOFF DTI MDLPRM", "pictures, sets and output"},
    {"SEQGP EPOINT NOLIN* TF", "numbering and control systems"},
    {"PBCOMP PBEND PBUSH1D PSHEAR PSOLID PLSOLID PLPLANE PGAP PMASS PWELD PFAST PAABSF MAT3 MAT9 MAT10 MAT11",
     "properties and materials of elements that are not read: those would be named on their own"},
    {"MAT4 MAT5 CHBDY* PHBDY CONV CONVM PCONV PCONVM QBDY* QHBDY QVOL QVECT RADBC RADM RADSET VIEW VIEW3D TEMPBC "
     "TEMPN1",
     "heat is no part of K and M"},
    {"AERO AEROS AEFACT AELIST AELINK AEPARM AESTAT AESURF AESURFS AECOMP AECOMPL CAERO* PAERO* SPLINE* TRIM MKAERO* "
     "FLFACT FLUTTER GUST MONPNT* SET2",
     "aerodynamics is no part of K and M"},
    {"DESVAR DRESP* DCONSTR DCONADD DVPREL* DVMREL* DVCREL* DVGRID DVSHAP DOPTPRM DLINK DEQATN DSCREEN DTABLE DESGLB",
     "optimisation"},
}};

bool listed(std::string_view names, std::string_view card) {
  while (!names.empty()) {
    const std::size_t end = std::min(names.find(' '), names.size());
    std::string_view name = names.substr(0, end);
    names.remove_prefix(std::min(end + 1, names.size()));
    if (name.ends_with('*') ? card.starts_with(name.substr(0, name.size() - 1)) : card == name) return true;
  }
  return false;
}

constexpr std::string_view structural =
    "CBEAM3 CBEND CBUSH1D CSHEAR CQUAD CGAP CWELD CFAST CMASS* CONM1 CCONEAX CRAC* RBE1 RROD RTRPLT "
    "RSPLINE RSSCON RJOINT GENEL DMIG SPCAX RELEASE SEBULK SECONCT SEELT SEMPLN SELOC "
    "CSUPER BOLT BSURF BCTSET BGSET CAABSF CHACAB CFLUID2";

}  // namespace

void classify_rest(Draft& draft) {
  for (const auto& [card_name, cards] : draft.cards) {
    const std::string& name = card_name;  // a lambda of C++20 by clang 14 captures no structured binding
    for (const Card& card : cards) {
      const auto group = std::ranges::find_if(harmless, [&](const Harmless& h) { return listed(h.names, name); });
      if (name.starts_with("MATT") && draft.selection.material_temperature)
        draft.losses.add_physical(name, "case control selects a temperature of materials, which it is for",
                                  card.place());
      else if (name == "DMIG" && draft.selection.has_case_control)
        draft.losses.add(name, "matrices that case control does not select by K2GG or M2GG");
      else if (group != harmless.end())
        draft.losses.add(name, std::string(group->note));
      else if (listed("CTETRA CHEXA CPENTA CPYRAM", name))
        draft.losses.add_physical(name, own_matrices, card.place());
      else if (listed(structural, name))
        draft.losses.add_physical(name, "it adds or defines stiffness or mass and is not read", card.place());
      else
        draft.losses.add_physical(name.empty() ? "a card without a name" : name,
                                  "it is no card that is known here, so what it does cannot be told", card.place());
    }
  }
  draft.cards.clear();
}

}  // namespace tenon::fem::nastran
