// Reads the tables [[body]] of a machine file.
#pragma once

#include "machines/machine.h"
#include "machines/toml/table_reader.h"

namespace toothpath::machines {

/// `body` of a machine whose chain has been read; what is wrong with it is recorded. Mesh files are not opened here.
void read_bodies(toml::TableReader& root, Machine& machine);

/// `chain.order`: the axes from the work to the tool and "bed" among them. Nothing is kept of one that does not fit the
/// chain. @param chain_table [chain] of the file
void read_chain_order(toml::TableReader& chain_table, KinematicChain& chain);

}  // namespace toothpath::machines
