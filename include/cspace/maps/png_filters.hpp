// The filters of PNG images undone: each byte was stored as its difference to what its neighbours foretell
// (W3C, Portable Network Graphics, 2003, section 9).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace cspace::maps {

// Of left, above and the one between them the nearest to left + above - between.
inline std::uint8_t paeth(int left, int above, int between) {
    const int guess = left + above - between;
    const int a = std::abs(guess - left), b = std::abs(guess - above), c = std::abs(guess - between);
    return std::uint8_t(a <= b && a <= c ? left : b <= c ? above : between);
}

// lines: `rows` lines of the number of a filter and `width` bytes; pixels: the bytes without it; step: bytes
// from one pixel to the next. The row with a filter that does not exist, or -1.
inline std::ptrdiff_t undo_png_filters(const std::uint8_t* lines, std::size_t rows, std::size_t width,
                                       std::size_t step, std::uint8_t* pixels) {
    for (std::size_t row = 0; row < rows; ++row) {
        const std::uint8_t* line = lines + row * (width + 1);
        const int filter = line[0];
        if (filter > 4) return std::ptrdiff_t(row);
        std::uint8_t* out = pixels + row * width;
        const std::uint8_t* up = row ? out - width : nullptr;
        for (std::size_t k = 0; k < width; ++k) {
            const int left = k >= step ? out[k - step] : 0, above = up ? up[k] : 0;
            const int between = up && k >= step ? up[k - step] : 0;
            int guess = 0;
            switch (filter) {
                case 1:
                    guess = left;
                    break;
                case 2:
                    guess = above;
                    break;
                case 3:
                    guess = (left + above) / 2;
                    break;
                case 4:
                    guess = paeth(left, above, between);
                    break;
                default:
                    break;
            }
            out[k] = std::uint8_t(line[k + 1] + guess);
        }
    }
    return -1;
}

}  // namespace cspace::maps
