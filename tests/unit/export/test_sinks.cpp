// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/export/field_sink.hpp"
#include "platform/export/mcap_writer.hpp"
#include "rt_core/math/infinity.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <map>

// tests/integration/hrtc/read_exports.py reads whole files, field by field; these are the edge
// cases.
namespace tactus::test
{
namespace
{

/// Writes one value of each kind.
void tell(FieldSink& sink, bool are_known)
{
    const Eigen::Quaterniond turned(0.5, 0.5, -0.5, 0.5);
    sink.number("number_m", are_known ? std::optional(0.1) : std::nullopt);
    sink.integer("integer", are_known ? std::optional<std::int64_t>(-7) : std::nullopt);
    sink.flag("flag", are_known);
    sink.text("text", are_known ? "word" : "");
    sink.words("words",
               are_known ? std::vector<std::string>{"one", "two"} : std::vector<std::string>{});
    sink.vector("vector_m", are_known ? std::optional(Vec3(1.0, -2.5, 1e-7)) : std::nullopt);
    sink.rotation("rotation", are_known ? std::optional(turned) : std::nullopt);
}

TEST(JsonSink, writes_what_is_known_and_null_for_the_rest)
{
    JsonSink sut;
    tell(sut, true);
    EXPECT_EQ(sut.take(), R"({"number_m":0.1,"integer":-7,"flag":true,"text":"word",)"
                          R"("words":["one","two"],"vector_m":[1,-2.5,1e-07],)"
                          R"("rotation":[0.5,-0.5,0.5,0.5]})");
    tell(sut, false);
    EXPECT_EQ(sut.take(), R"({"number_m":null,"integer":null,"flag":false,"text":"",)"
                          R"("words":[],"vector_m":null,"rotation":null})");
}

TEST(JsonSink, writes_no_number_that_json_does_not_know)
{
    JsonSink sut;
    sut.number("far_m", kInfinity);
    sut.vector("broken_m", Vec3(std::nan(""), 1.0, -kInfinity));
    EXPECT_EQ(sut.take(), R"({"far_m":null,"broken_m":[null,1,null]})");
}

TEST(JsonSink, escapes_texts_from_outside)
{
    JsonSink sut;
    sut.text("name", "a\"b\\c\n\x01\xff");
    const auto parsed = nlohmann::json::parse(sut.take());
    EXPECT_EQ(parsed.at("name"), "a\"b\\c???");
}

TEST(JsonSink, nests_objects_and_lists)
{
    JsonSink sut;
    sut.open("inner");
    sut.integer("a", 1);
    sut.close();
    sut.open_list("none");
    sut.close_list();
    sut.open_list("list");
    for (int i = 0; i < 2; ++i)
    {
        sut.open_item();
        sut.integer("i", i);
        sut.close();
    }
    sut.close_list();
    sut.flag("last", true);
    EXPECT_EQ(sut.take(), R"({"inner":{"a":1},"none":[],"list":[{"i":0},{"i":1}],"last":true})");
}

TEST(SchemaSink, has_the_keys_of_the_object)
{
    JsonSink json;
    SchemaSink sut;
    tell(json, true);
    tell(sut, false);
    const auto object = nlohmann::ordered_json::parse(json.take());
    const auto schema = nlohmann::ordered_json::parse(sut.take());
    EXPECT_EQ(schema.at("type"), "object");
    std::vector<std::string> keys;
    for (const auto& [key, value] : schema.at("properties").items())
    {
        keys.push_back(key);
    }
    std::vector<std::string> expected;
    for (const auto& [key, value] : object.items())
    {
        expected.push_back(key);
    }
    EXPECT_EQ(keys, expected);
}

TEST(CsvSink, has_as_many_cells_as_names)
{
    CsvSink sut;
    sut.begin(CsvSink::Cells::names);
    tell(sut, true);
    sut.begin(CsvSink::Cells::names, "tool0.");
    sut.flag("flag", true);
    EXPECT_EQ(sut.take(), "number_m,integer,flag,text,words,vector_m.x,vector_m.y,vector_m.z,"
                          "rotation.x,rotation.y,rotation.z,rotation.w,tool0.flag\r\n");
    sut.begin(CsvSink::Cells::values);
    tell(sut, true);
    sut.begin(CsvSink::Cells::empty, "tool0.");
    sut.flag("flag", true);
    EXPECT_EQ(sut.take(), "0.1,-7,1,word,one two,1,-2.5,1e-07,0.5,-0.5,0.5,0.5,\r\n");
    sut.begin(CsvSink::Cells::values);
    tell(sut, false);
    sut.number("far_m", -kInfinity);
    EXPECT_EQ(sut.take(), ",,0,,,,,,,,,,-inf\r\n");
}

using Bytes = std::vector<std::byte>;

constexpr int kMessageIndex = 7;
constexpr int kChunk = 6;
constexpr int kChunkIndex = 8;

/// Number of records of each kind outside the chunks; asserts that a file consists only of whole
/// records between two magics.
std::map<int, int> records_of(const Bytes& file)
{
    std::map<int, int> counts;
    std::size_t at = 8;
    while (at + 8 < file.size())
    {
        std::uint64_t size = 0;
        std::memcpy(&size, file.data() + at + 1, sizeof(size));
        ++counts[static_cast<int>(file[at])];
        at += 9 + size;
    }
    EXPECT_EQ(at + 8, file.size());
    EXPECT_EQ(std::memcmp(file.data(), "\x89MCAP0\r\n", 8), 0);
    EXPECT_EQ(std::memcmp(file.data() + file.size() - 8, "\x89MCAP0\r\n", 8), 0);
    return counts;
}

TEST(McapWriter, lays_out_a_file_without_messages)
{
    McapWriter sut("library");
    sut.finish();
    // Header, end of data, statistics, their index, footer.
    EXPECT_EQ(records_of(sut.take_bytes()),
              (std::map<int, int>{{0x01, 1}, {0x0F, 1}, {0x0B, 1}, {0x0E, 1}, {0x02, 1}}));
}

TEST(McapWriter, keeps_a_channel_that_nothing_was_sent_on)
{
    McapWriter sut("library");
    const auto schema = sut.add_schema("Name", "{}");
    static_cast<void>(sut.add_channel("/topic", schema));
    sut.finish();
    const auto counts = records_of(sut.take_bytes());
    EXPECT_EQ(counts.at(0x03), 1);
    EXPECT_EQ(counts.at(0x04), 1);
    EXPECT_EQ(counts.at(kChunk), 1); // Their first declaration.
    EXPECT_FALSE(counts.contains(kMessageIndex));
}

TEST(McapWriter, ends_a_chunk_where_it_is_full)
{
    McapWriter sut("library");
    const auto channel = sut.add_channel("/topic", sut.add_schema("Name", "{}"));
    const std::string half(McapWriter::kChunkBytes / 2, 'x');
    Bytes file;
    for (std::uint32_t i = 0; i < 5; ++i)
    {
        sut.add_message(channel, i, 100 - i, half); // Descending times.
        const Bytes more = sut.take_bytes();
        file.insert(file.end(), more.begin(), more.end());
    }
    sut.finish();
    const Bytes more = sut.take_bytes();
    file.insert(file.end(), more.begin(), more.end());
    const auto counts = records_of(file);
    EXPECT_EQ(counts.at(kChunk), 3); // Two messages each, and the last one.
    EXPECT_EQ(counts.at(kMessageIndex), 3);
    EXPECT_EQ(counts.at(kChunkIndex), 3);
}

} // namespace
} // namespace tactus::test
