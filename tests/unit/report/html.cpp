// The page as text; that it works in a browser is tests/cli/report_browser/browser.mjs.
#include <maupertuis/report.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>

using namespace maupertuis;

namespace {

bool has(const std::string& page, const std::string& part) { return page.find(part) != std::string::npos; }

Drawing one_point() {
  Drawing drawing;
  drawing.times = {0, 1};
  drawing.elements = {{Drawing::Kind::Path, 1, {0, 0, 1, std::nan("")}, false, {1}, {0.1}, {"A"}, {}, {}}};
  return drawing;
}

}  // namespace

TEST_CASE("an empty report is a page without sections") {
  const std::string page = report_html({});
  CHECK(page.rfind("<!DOCTYPE html>", 0) == 0);
  CHECK_FALSE(has(page, "<section"));
  CHECK_FALSE(has(page, "<canvas"));
  CHECK_FALSE(has(page, "requestAnimationFrame"));
}

TEST_CASE("the page asks nobody for anything") {
  ReportContent content;
  content.drawing = one_point();
  content.title = "A";
  const std::string page = report_html(content);
  CHECK(has(page, "default-src 'none'"));
  for (const char* outside :
       {"https://", "<script src", "<link rel=\"stylesheet\"", "@import", "url(", "fetch(", "XMLHttpRequest"})
    CHECK_FALSE(has(page, outside));
}

TEST_CASE("what users write is text on the page") {
  ReportContent content;
  content.title = content.source = content.model_text = content.file = "<script>alert(1)</script>";
  content.messages = {{Severity::Warning, "W0001", "<b>", "<i>", "<u>", 1, "<pre>"}};
  content.expectations = {{1, "expect <x>", false, false, "<y>", "", "", "", false, "<z>", "<q>", ""}};
  const std::string page = report_html(content);
  CHECK_FALSE(has(page, "<script>alert"));
  for (const char* tag : {"<b><", "<i>", "<u>", "<x>", "<y>", "<z>", "<q>"}) CHECK_FALSE(has(page, tag));
  CHECK(has(page, "&lt;script&gt;alert(1)&lt;/script&gt;"));
}

TEST_CASE("a derivation that is not certified says so") {
  ReportContent content;
  content.certificate = {{"jet_residual", "R agrees.", "differs", false, true, 3, 1}};
  content.certified = false;
  const std::string page = report_html(content);
  CHECK(has(page, "✗ differs"));
  CHECK(has(page, "do not rely on it"));
  CHECK(has(page, "✗ not certified"));
  CHECK_FALSE(has(page, "✓"));
}

TEST_CASE("a run that ended early says why") {
  ReportContent content;
  content.ending = "The mass matrix became singular at t = 2 s.";
  CHECK(has(report_html(content), "The mass matrix became singular at t = 2 s."));
}

TEST_CASE("a lost position is null in the data of the animation") {
  ReportContent content;
  content.drawing = one_point();
  CHECK(has(report_html(content), "\"positions\":[0,0,1,null]"));
}
