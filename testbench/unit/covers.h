// Names the requirement IDs that a test covers; docs/traceability.md is generated from these lines.
#pragma once

#include <gtest/gtest.h>

// BRICK_COVERS("BREQ-1 BREQ-3"): first line of a test.
#define BRICK_COVERS(ids) ::testing::Test::RecordProperty("requirements", ids)
