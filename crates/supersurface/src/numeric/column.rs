//! Numbers side by side in memory that begins with a cache line.

use std::ops::{Deref, DerefMut};

/// Bytes of a cache line: what a wide register loads at once, where it begins with one.
const LINE: usize = 64;

/// A growing row of numbers that begins with a cache line.
#[derive(Debug, Default)]
pub struct Column<T> {
    /// The numbers from `start` on, which depends on where the memory lies.
    room: Vec<T>,
    start: usize,
    count: usize,
}

impl<T: Copy> Column<T> {
    /// Leaves no numbers, but their room.
    pub const fn clear(&mut self) {
        self.count = 0;
    }

    /// Appends a number.
    #[inline]
    pub fn push(&mut self, value: T) {
        if let Some(place) = self.room.get_mut(self.start + self.count) {
            *place = value;
            self.count += 1;
        } else {
            self.resize(self.count + 1, value);
        }
    }

    /// Cuts the row, or appends `value` up to a length.
    pub fn resize(&mut self, count: usize, value: T) {
        if self.start + count > self.room.len() {
            let mut room = vec![value; count.max(2 * self.count) + LINE];
            let start = room.as_ptr().align_offset(LINE).min(LINE);
            room[start..start + self.count].copy_from_slice(self);
            (self.room, self.start) = (room, start);
        } else if count > self.count {
            self.room[self.start + self.count..self.start + count].fill(value);
        }
        self.count = count;
    }
}

impl<T: Copy + Default> FromIterator<T> for Column<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        let mut column = Self::default();
        values.into_iter().for_each(|v| column.push(v));
        column
    }
}

impl<'a, T> IntoIterator for &'a Column<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<T> Deref for Column<T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        &self.room[self.start..self.start + self.count]
    }
}

impl<T> DerefMut for Column<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.room[self.start..self.start + self.count]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_begins_with_a_line_and_keeps_its_numbers() {
        for n in [0, 1, 7, 64, 1000] {
            let mut column: Column<f32> = (0..n).map(|i| i as f32).collect();
            assert!(column.iter().enumerate().all(|(i, v)| *v == i as f32), "{n}");
            assert!(n == 0 || column.as_ptr().align_offset(LINE) == 0);
            column.resize(n + 3, 5.0);
            assert_eq!((column.len(), column[n + 2]), (n + 3, 5.0));
            column.clear();
            column.resize(2, 1.0);
            assert_eq!(&column[..], [1.0, 1.0]);
        }
    }
}
