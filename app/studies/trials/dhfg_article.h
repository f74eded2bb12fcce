// The study against the article that it follows: X. Chu, F. Chen, Machines 2025, 13, 912.
#pragma once

#include "app/report/page/report_page.h"
#include "app/studies/trials/dhfg_samples.h"

namespace toothpath::trials {

/// Every statement of the article on its trials, with the section, what is found here, and the verdict, by the numbers.
/// Without rows where a trial has no numbers.
[[nodiscard]] page::PageTable article_table(const StudyFacts& facts, const StudyFound& found);

}  // namespace toothpath::trials
