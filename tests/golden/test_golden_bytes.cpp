// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/encode/write_spm.hpp"
#include "tests/golden/golden_model.hpp"
#include "transport/store/model_store.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace tactus
{

namespace
{

/// Chunk in the middle: its records depend on earlier, neighbouring and own ones.
constexpr ChunkId kGoldenChunk{1};

std::string hex_of(std::span<const std::byte> bytes)
{
    constexpr const char* kDigits = "0123456789abcdef";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); ++i)
    {
        const auto value = static_cast<std::uint8_t>(bytes[i]);
        text += kDigits[value >> 4U];
        text += kDigits[value & 15U];
        text += i % 32 == 31 || i + 1 == bytes.size() ? "\n" : "";
    }
    return text;
}

void expect_golden(const std::string& name, std::span<const std::byte> bytes)
{
    const std::filesystem::path path = std::filesystem::path(TACTUS_GOLDEN_DIR) / name;
    const char* rewrite = std::getenv("TACTUS_REWRITE_GOLDEN");
    if (rewrite != nullptr && std::string(rewrite) == "1")
    {
        std::ofstream(path) << hex_of(bytes);
        ADD_FAILURE() << "wrote " << path << "; run again without TACTUS_REWRITE_GOLDEN";
        return;
    }
    std::ifstream file(path);
    std::ostringstream golden;
    golden << file.rdbuf();
    ASSERT_FALSE(golden.str().empty()) << path << " is missing; see README.md beside it";
    EXPECT_EQ(hex_of(bytes), golden.str()) << "the bytes of " << name << " have changed";
}

class GoldenBytes : public testing::Test
{
protected:
    void SetUp() override
    {
        const PreparedMesh prepared = make_golden_mesh();
        const Simplification simplification = collapse_plainly(prepared.mesh, 16);
        const auto written = write_spm(path_, prepared, simplification, {});
        ASSERT_TRUE(written) << written.error().text;
    }
    void TearDown() override { std::filesystem::remove(path_); }

    // Tests run in parallel in separate processes.
    std::filesystem::path path_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".spm");
};

TEST_F(GoldenBytes, a_header_is_what_it_was)
{
    const auto store = ModelStore::open(path_);
    ASSERT_TRUE(store) << store.error().text;
    expect_golden("header.hex", store.value().header_bytes());
}

TEST_F(GoldenBytes, a_coded_chunk_is_what_it_was)
{
    const auto store = ModelStore::open(path_);
    ASSERT_TRUE(store) << store.error().text;
    std::vector<std::byte> coded;
    ASSERT_TRUE(store.value().read({ContentKind::chunk, kGoldenChunk.value}, coded));
    expect_golden("chunk.hex", coded);
}

TEST_F(GoldenBytes, a_page_is_what_it_was_after_parse_and_link)
{
    const auto store = ModelStore::open(path_);
    ASSERT_TRUE(store) << store.error().text;
    std::vector<std::string> damage;
    const DecodedModel model = DecodedModel::decode(store.value(), damage);
    ASSERT_TRUE(damage.empty());
    expect_golden("page.hex", std::as_bytes(std::span(&model.page(kGoldenChunk), 1)));
}

} // namespace

} // namespace tactus
