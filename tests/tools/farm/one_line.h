#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/core/result.h"

namespace skerry::tools {

/// An error of one line that has all of `parts`.
template <class T>
void expect_one_line(const Result<T>& result, const std::vector<std::string>& parts) {
  ASSERT_FALSE(result);
  const std::string& message = result.error().message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << ": " << message;
}

}  // namespace skerry::tools
