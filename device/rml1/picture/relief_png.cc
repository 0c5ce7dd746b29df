#include <png.h>

#include <string>

#include "device/rml1/picture/relief.h"

namespace axisgate::rml1 {

std::string png_of(const Relief& relief) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(relief.width());
  image.height = static_cast<png_uint_32>(relief.height());
  image.format = PNG_FORMAT_BGRA;  // 0xaarrggbb in memory
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  const bool written =
      png_image_write_to_memory(&image, bytes.data(), &size, 0, relief.pixels().data(), 0, nullptr) != 0;
  bytes.resize(written ? size : 0);
  return bytes;
}

}  // namespace axisgate::rml1
