// Values that nobody measured, told in few lines.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace toothpath::machines {

/// Keys of one table in one line, tables with the same keys too: "axes.X, axes.Y: min, max". A key may follow the name
/// of its file ("t600s.toml: axes.X.min"); lines that say a value ("..: post.corner_tolerance = ..") stay as they are.
/// Keeps the order in which the tables first come. Lines longer than `width` are broken behind a comma, so that a
/// remark of any control holds them. More than `most` lines: the last one counts what is left out.
/// @param most at least 2
[[nodiscard]] std::vector<std::string> grouped_keys(std::span<const std::string> keys, std::size_t most = 10,
                                                    std::size_t width = 68);

/// One line: how many, of which tables: "39 values of t600s.toml, not measured: dialect, axes (24), post (2)". Empty:
/// none.
[[nodiscard]] std::string counted_keys(std::span<const std::string> keys);

}  // namespace toothpath::machines
