#include <opencv2/imgcodecs.hpp>

#include "core/expect.hpp"
#include "recording/picture_file.hpp"
#include "tests/fuzz/driver.hpp"

using namespace smokemap;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const PictureLimits limits;
  const auto header = read_picture_header({data, size}, limits);
  if (header && header->type != PictureType::kPdf)
    ENGINE_EXPECT(header->width_px > 0 && header->height_px > 0 &&
                  static_cast<double>(header->width_px) * header->height_px <= limits.max_megapixels * 1e6);
  return 0;
}

std::vector<fuzz::Bytes> fuzz::seed_corpus() {
  const cv::Mat picture(8, 8, CV_8UC3, cv::Scalar(1, 2, 3));
  std::vector<Bytes> corpus{bytes_of("%PDF-1.4\n1 0 obj<</Type/Catalog>>endobj\n")};
  for (const char* extension : {".png", ".jpg", ".webp"}) cv::imencode(extension, picture, corpus.emplace_back());
  return corpus;
}
