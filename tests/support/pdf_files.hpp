#pragma once

#include <zlib.h>

#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "core/random.hpp"

namespace smokemap::test {

/// A document of an intake test.
struct PdfFile {
  const char* name;
  std::string bytes;
};

namespace pdf {

/// Objects by number; 1 is the catalogue.
inline std::string document(const std::map<int, std::string>& objects) {
  std::string out = "%PDF-1.5\n";
  for (const auto& [number, body] : objects) out += std::to_string(number) + " 0 obj" + body + "endobj\n";
  return out + "trailer<</Root 1 0 R>>\n%%EOF\n";
}

inline std::string stream(const std::string& data, const std::string& entries = "") {
  return "<<" + entries + "/Length " + std::to_string(data.size()) + ">>stream\n" + data + "\nendstream ";
}

/// One page of A4. Further objects from number 10 on.
inline std::string page(const std::string& content, const std::string& resources = "",
                        std::map<int, std::string> more = {}, const std::string& box = "0 0 595 842",
                        const std::string& content_entries = "") {
  more[1] = "<</Type/Catalog/Pages 2 0 R>>";
  more[2] = "<</Type/Pages/Kids[3 0 R]/Count 1>>";
  more[3] = "<</Type/Page/Parent 2 0 R/MediaBox[" + box + "]/Contents 4 0 R/Resources<<" + resources + ">>>>";
  more[4] = stream(content, content_entries);
  return document(more);
}

inline std::string pages(int count) {
  std::string kids;
  std::map<int, std::string> objects{{1, "<</Type/Catalog/Pages 2 0 R>>"}, {3, stream("0 0 m 595 842 l S")}};
  for (int i = 0; i < count; ++i) {
    kids += std::to_string(4 + i) + " 0 R ";
    objects[4 + i] = "<</Type/Page/Parent 2 0 R/MediaBox[0 0 595 842]/Contents 3 0 R>>";
  }
  objects[2] = "<</Type/Pages/Kids[" + kids + "]/Count " + std::to_string(count) + ">>";
  return document(objects);
}

inline std::string times(const std::string& text, int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += text;
  return out;
}

/// `megabytes` of `unit` over and over, deflated to a hundredth.
inline std::string deflated(const std::string& unit, int megabytes) {
  const std::string piece = times(unit, static_cast<int>((1 << 20) / unit.size()));
  z_stream z{};
  std::string out;
  std::vector<unsigned char> buffer(1 << 16);
  if (deflateInit(&z, 1) != Z_OK) return out;
  for (int i = 0; i <= megabytes; ++i) {
    z.next_in = reinterpret_cast<unsigned char*>(const_cast<char*>(piece.data()));
    z.avail_in = i < megabytes ? static_cast<unsigned>(piece.size()) : 0;
    do {
      z.next_out = buffer.data();
      z.avail_out = static_cast<unsigned>(buffer.size());
      deflate(&z, i < megabytes ? Z_NO_FLUSH : Z_FINISH);
      out.append(reinterpret_cast<const char*>(buffer.data()), buffer.size() - z.avail_out);
    } while (z.avail_out == 0);
  }
  deflateEnd(&z);
  return out;
}

constexpr const char* kForm = "/Type/XObject/Subtype/Form/BBox[0 0 595 842]";

/// Forms that each draw the next one `fan` times.
inline std::string nested_forms(int depth, int fan, const std::string& group) {
  std::map<int, std::string> more;
  for (int k = 0; k < depth; ++k) {
    const std::string next = std::to_string(k + 1), object = std::to_string(11 + k);
    more[10 + k] = stream(k + 1 < depth ? times("/F" + next + " Do ", fan) : "0 0 99 99 re f",
                          kForm + group + "/Resources<</XObject<</F" + next + " " + object + " 0 R>>>>");
  }
  return page("/F0 Do", "/XObject<</F0 10 0 R>>", std::move(more));
}

inline std::string tiled(const std::string& step) {
  const std::string entries =
      "/Type/Pattern/PatternType 1/PaintType 1/TilingType 1/BBox[0 0 1 1]/Resources<<>>/XStep " + step + "/YStep " +
      step;
  return page("/Pattern cs /P scn 0 0 595 842 re f", "/Pattern<</P 10 0 R>>", {{10, stream("0 0 1 1 re f", entries)}});
}

inline std::string picture_page(const std::string& data, int width, int height, int times_drawn) {
  const std::string entries =
      "/Type/XObject/Subtype/Image/ColorSpace/DeviceRGB/BitsPerComponent 8/Filter/FlateDecode"
      "/Width " +
      std::to_string(width) + "/Height " + std::to_string(height);
  return page(times("q 595 0 0 842 0 0 cm /I Do Q ", times_drawn), "/XObject<</I 10 0 R>>",
              {{10, stream(data, entries)}});
}

/// Short strokes along both axes, as a CAD program writes a floor plan with furniture and hatching.
inline std::string strokes(int count) {
  std::mt19937_64 random(1);
  std::string content = ".3 w ";
  for (int i = 0; i < count; ++i) {
    const int x = 20 + static_cast<int>(uniform_index(random, 540)),
              y = 20 + static_cast<int>(uniform_index(random, 800)),
              length = 1 + static_cast<int>(uniform_index(random, 16));
    content += std::to_string(x) + " " + std::to_string(y) + " m " + std::to_string(i % 2 ? x + length : x) + " " +
               std::to_string(i % 2 ? y : y + length) + " l S ";
  }
  return page(content);
}

inline std::string page_tree(int depth) {
  std::map<int, std::string> objects{{1, "<</Type/Catalog/Pages 2 0 R>>"}};
  for (int k = 2; k < depth; ++k)
    objects[k] =
        "<</Type/Pages/Count 1/Kids[" + std::to_string(k + 1) + " 0 R]/Parent " + std::to_string(k - 1) + " 0 R>>";
  objects[depth] = "<</Type/Page/MediaBox[0 0 595 842]/Parent " + std::to_string(depth - 1) + " 0 R>>";
  return document(objects);
}

}  // namespace pdf

/// Pages made to keep whoever draws them busy, or to take all memory.
inline std::vector<PdfFile> hostile_pdfs() {
  using namespace pdf;
  const std::string across = "0 0 m 595 842 l S ";
  const std::string glyph = stream("1000 0 d0 " + times("0 0 m 1000 1000 l S ", 200));
  return {
      {"200 000 lines across", page("1 w " + times(across, 200'000))},
      {"20 000 fills of the page", page(times("0 0 595 842 re f ", 20'000))},
      {"200 MB of blanks, deflated", page(deflated(" ", 200), "", {}, "0 0 595 842", "/Filter/FlateDecode")},
      {"50 MB of lines, deflated", page(deflated(across, 50), "", {}, "0 0 595 842", "/Filter/FlateDecode")},
      {"forms: ten times ten times ...", nested_forms(12, 10, "")},
      {"form that draws itself",
       page("/F Do", "/XObject<</F 10 0 R>>",
            {{10, stream("/F Do /F Do", std::string(kForm) + "/Resources<</XObject<</F 10 0 R>>>>")}})},
      {"80 nested transparencies", nested_forms(80, 1, "/Group<</S/Transparency/I true>>")},
      {"tiles of a hundredth point", tiled("0.01")},
      {"dashes of 0.0001 point", page("[.0001 .0001] 0 d 1 w " + across)},
      {"dashes of 0.01 point, often", page("[.01 .01] 0 d 1 w " + times(across, 100))},
      {"picture: 30000 x 30000", picture_page(deflated(std::string(1, '\0'), 100), 30'000, 30'000, 1)},
      {"picture drawn 300 times", picture_page(deflated("\x7f", 12), 2000, 2000, 300)},
      {"clips in clips",
       page(times("1 1 400 400 re W n 3 0 m 590 840 l 9 99 l h W n ", 10'000) + times("0 0 595 842 re f ", 2000))},
      {"type 3 font, heavy letters",
       page("BT /T 10 Tf " + times("(aaaaaaaaaaaaaaaa) Tj ", 20'000) + "ET", "/Font<</T 10 0 R>>",
            {{10,
              "<</Type/Font/Subtype/Type3/FontBBox[0 0 1000 1000]/FontMatrix[.001 0 0 .001 0 0]/CharProcs<</a 11 0 R>>"
              "/Encoding<</Type/Encoding/Differences[97/a]>>/FirstChar 97/LastChar 97/Widths[10]>>"},
             {11, glyph}})},
      {"shading with a long formula", page("/S sh",
                                           "/Shading<</S<</ShadingType 1/ColorSpace/DeviceRGB/Domain[0 1 0 "
                                           "1]/Matrix[595 0 0 842 0 0]/Function 10 0 R>>>>",
                                           {{10, stream("{" + times("sin cos ", 2000) + " dup }",
                                                        "/FunctionType 4/Domain[0 1 0 1]/Range[0 1 0 1 0 1]")}})},
      {"page of 1e9 x 1e9 points", page("0 0 m 1e9 1e9 l S", "", {}, "0 0 1e9 1e9")},
      {"page of 1e9 x 1 points", page("0 0 m 1e9 1 l S", "", {}, "0 0 1e9 1")},
      {"page of 1e-9 points", page("0 0 m 1 1 l S", "", {}, "0 0 1e-9 1e-9")},
      {"arrays a million deep", page("q " + std::string(1'000'000, '[') + " Q")},
      {"catalogue a million deep", document({{1, "<</Type/Catalog/Pages 2 0 R/X " + std::string(1'000'000, '[') + ">>"},
                                             {2, "<</Type/Pages/Kids[]/Count 0>>"}})},
      {"page tree 20 000 deep", page_tree(20'000)},
      {"page tree in a ring",
       document({{1, "<</Type/Catalog/Pages 2 0 R>>"}, {2, "<</Type/Pages/Kids[2 0 R 2 0 R]/Count 2000000000>>"}})},
      {"a million states saved", page(times("q ", 1'000'000))},
      {"20 MB of object heads", "%PDF-1.4\n" + times("1 0 obj ", 2'500'000)},
  };
}

/// Pages that are much work and mean no harm.
inline std::vector<PdfFile> heavy_pdfs() {
  using namespace pdf;
  return {{"plan of 30 000 strokes", strokes(30'000)},
          {"plan of 100 000 strokes", strokes(100'000)},
          {"plan of 300 000 strokes", strokes(300'000)},
          {"scan of an A4 at 300 dpi", picture_page(deflated("paper, and ink ", 25), 2480, 3508, 1)},
          {"500 pages", pages(500)}};
}

}  // namespace smokemap::test
