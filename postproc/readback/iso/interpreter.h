// The family of controls that speak ISO 6983: words of a letter and a number, G and M codes, comments in parentheses.
#pragma once

#include <string>
#include <string_view>

#include "postproc/readback/iso/language.h"
#include "postproc/readback/reader.h"

namespace toothpath::iso {

/// Executes what we write for a control of the family; everything else is refused where it stands.
[[nodiscard]] Status execute_iso(std::string_view text, const std::string& file, const readback::NcControl& control,
                                 const readback::MoveSink& sink, const IsoLanguage& language);

}  // namespace toothpath::iso
