// One reader under libFuzzer: TOOTHPATH_READER names it, `--readers` lists them. `-runs`, `-max_total_time` and a
// corpus folder as with every libFuzzer program; an empty folder is filled with the seeds.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "tests/fuzz/readers.h"
#include "tests/support/files.h"

namespace {

const toothpath::test::ByteReader* reader = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  if (*argc == 2 && std::string_view((*argv)[1]) == "--readers") {
    for (const auto& known : toothpath::test::fuzzed_readers()) std::printf("%s\n", known.name.c_str());
    std::exit(0);
  }
  const char* name = std::getenv("TOOTHPATH_READER");
  for (const auto& known : toothpath::test::fuzzed_readers())
    if (name && known.name == name) reader = &known;
  if (!reader) {
    std::fputs("TOOTHPATH_READER must be one of:", stderr);
    for (const auto& known : toothpath::test::fuzzed_readers()) std::fprintf(stderr, " %s", known.name.c_str());
    std::fputs("\n", stderr);
    std::exit(2);
  }
  if (*argc > 1 && std::filesystem::is_directory((*argv)[1]) && std::filesystem::is_empty((*argv)[1]))
    for (std::size_t k = 0; k < reader->seeds.size(); ++k)
      toothpath::test::write_file((*argv)[1] + ("/seed" + std::to_string(k)), reader->seeds[k]);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string fault = reader->fault_of({reinterpret_cast<const char*>(bytes), size});
  if (fault.empty()) return 0;
  std::fprintf(stderr, "%s\n", fault.c_str());
  std::abort();
}
