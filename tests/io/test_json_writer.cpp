#include "core/errors.h"
#include "io/json_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sandflow {
namespace {

std::string quote(std::string_view text)
{
    JsonWriter json;
    json.value(text);
    return json.text();
}

TEST(JsonWriter, nestsObjectsAndArrays)
{
    JsonWriter json;
    json.beginObject().member("scene", "floor").member("threads", 4).member("ledger_ok", true);
    json.key("heap").beginObject().member("apex_m", 0.25).endObject();
    json.key("rows").beginArray().value(1).value(-2).null().beginObject().endObject().endArray();
    json.key("empty").beginArray().endArray().endObject();
    EXPECT_EQ(json.text(),
              "{\n  \"scene\": \"floor\",\n  \"threads\": 4,\n  \"ledger_ok\": true,\n"
              "  \"heap\": {\n    \"apex_m\": 0.25\n  },\n"
              "  \"rows\": [\n    1,\n    -2,\n    null,\n    {}\n  ],\n  \"empty\": []\n}\n");
}

TEST(JsonWriter, whatIsMissingIsNull)
{
    JsonWriter json;
    json.beginObject().member("repose_deg", std::optional<double>());
    json.member("ratio", std::optional(0.5)).endObject();
    EXPECT_EQ(json.text(), "{\n  \"repose_deg\": null,\n  \"ratio\": 0.5\n}\n");
}

TEST(JsonWriter, escapesWhatJsonForbidsInText)
{
    EXPECT_EQ(quote("a\"b\\c\nd\re\tf"), "\"a\\\"b\\\\c\\nd\\re\\tf\"\n");
    EXPECT_EQ(quote(std::string_view("\0\x1f\x7f", 3)), "\"\\u0000\\u001f\x7f\"\n");
}

TEST(JsonWriter, keepsUtf8AndMarksWhatIsNot)
{
    EXPECT_EQ(quote("D\xC3\xBCne \xE6\xB2\x99 \xF0\x9F\x8F\x96"),
              "\"D\xC3\xBCne \xE6\xB2\x99 \xF0\x9F\x8F\x96\"\n");
    EXPECT_EQ(quote("D\xFCne"), "\"D\\ufffdne\"\n");
    EXPECT_EQ(quote("cut \xE6\xB2"), "\"cut \\ufffd\\ufffd\"\n");
    EXPECT_EQ(quote("\xC0\xAF"), "\"\\ufffd\\ufffd\"\n") << "overlong";
    EXPECT_EQ(quote("\xED\xA0\x80"), "\"\\ufffd\\ufffd\\ufffd\"\n") << "surrogate";
}

TEST(JsonWriter, writesNumbersThatReadBack)
{
    JsonWriter json;
    json.beginArray().value(0.1).value(1e-300).value(std::numeric_limits<double>::quiet_NaN());
    json.value(-std::numeric_limits<double>::infinity());
    json.value(std::numeric_limits<std::uint64_t>::max());
    json.value(std::numeric_limits<std::int64_t>::min()).endArray();
    EXPECT_EQ(json.text(),
              "[\n  0.1,\n  1e-300,\n  null,\n  null,\n  18446744073709551615,\n"
              "  -9223372036854775808\n]\n");
}

TEST(JsonWriter, refusesWrongNesting)
{
    EXPECT_THROW(JsonWriter().text(), InternalError);
    EXPECT_THROW(JsonWriter().beginObject().text(), InternalError);
    EXPECT_THROW(JsonWriter().beginObject().value(1), InternalError);
    EXPECT_THROW(JsonWriter().beginArray().key("a"), InternalError);
    EXPECT_THROW(JsonWriter().beginArray().endObject(), InternalError);
    EXPECT_THROW(JsonWriter().beginObject().key("a").endObject(), InternalError);
    EXPECT_THROW(JsonWriter().beginObject().key("a").key("b"), InternalError);
    EXPECT_THROW(JsonWriter().value(1).value(2), InternalError);
}

}  // namespace
}  // namespace sandflow
