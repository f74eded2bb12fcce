// Numbers of 50 digits, for kernels that are templates of their scalar.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>

namespace toothpath::test {

using F50 = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;

}  // namespace toothpath::test
