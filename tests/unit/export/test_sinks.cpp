// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/export/field_sink.hpp"
#include "rt_core/math/infinity.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

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

} // namespace
} // namespace tactus::test
