//! Numbers in the rows of a file, whichever way it writes the decimal point.

/// Letter between the whole part and the fraction of a file's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Decimal {
    Point,
    Comma,
}

impl Decimal {
    fn name(self) -> &'static str {
        match self {
            Decimal::Point => "decimal points, or commas between its numbers",
            Decimal::Comma => "decimal commas",
        }
    }
}

/// Reader of rows of numbers, separated by blanks, tabs, commas or semicolons. With semicolons or tabs a comma stands for the decimal point, and with blanks where
/// each number is a whole one or has one comma with digits on both sides. All rows of a file have the same decimal letter.
#[derive(Debug, Default)]
pub struct Rows {
    /// Decimal letter of the first row that shows it, with its line.
    decimal: Option<(Decimal, usize)>,
}

impl Rows {
    /// Numbers of a line; `None` where a part is no number.
    ///
    /// # Errors
    /// The line has another decimal letter than one before, or commas that may be either, in words.
    pub fn numbers(&mut self, line: usize, content: &str) -> Result<Option<Vec<f64>>, String> {
        let Some((numbers, decimal)) = parse(content) else {
            // A heading has letters.
            if content.contains(',')
                && content.contains(|letter: char| letter.is_ascii_digit())
                && !content.contains(char::is_alphabetic)
            {
                return Err(format!(
                    "{content:?} is no row of numbers: its commas may be decimal ones or between numbers"
                ));
            }
            return Ok(None);
        };
        match (self.decimal, decimal) {
            (Some((before, first)), Some(decimal)) if before != decimal => Err(format!(
                "{content:?} has {}, and line {first} has {}: allowed is one of them in a file",
                decimal.name(),
                before.name()
            )),
            (None, Some(decimal)) => {
                self.decimal = Some((decimal, line));
                Ok(Some(numbers))
            }
            _ => Ok(Some(numbers)),
        }
    }
}

/// Numbers of a line, and the decimal letter where the line shows it: whole numbers between blanks do not.
fn parse(line: &str) -> Option<(Vec<f64>, Option<Decimal>)> {
    let has_comma = line.contains(',');
    let decimal = if has_comma && (line.contains([';', '\t']) || has_decimal_commas(line)) {
        Some(Decimal::Comma)
    } else if has_comma && mixes_commas(line) {
        return None;
    } else {
        (has_comma || line.contains('.')).then_some(Decimal::Point)
    };
    let is_separator =
        |letter: char| letter.is_whitespace() || letter == ';' || (letter == ',' && decimal != Some(Decimal::Comma));
    let parts = line.split(is_separator).filter(|part| !part.is_empty());
    let number = |part: &str| match decimal {
        Some(Decimal::Comma) if part.contains('.') => None,
        Some(Decimal::Comma) => part.replace(',', ".").parse().ok(),
        _ => part.parse().ok(),
    };
    let numbers: Option<Vec<f64>> = parts.map(number).collect();
    let numbers = numbers.filter(|numbers| !numbers.is_empty())?;
    Some((numbers, decimal))
}

/// Whether blanks separate the numbers of a line with commas: two or more, whole or with one comma between digits.
fn has_decimal_commas(line: &str) -> bool {
    let is_number = |part: &str| match part.split_once(',') {
        Some((whole, fraction)) => {
            whole.ends_with(|letter: char| letter.is_ascii_digit())
                && fraction.starts_with(|letter: char| letter.is_ascii_digit())
                && !fraction.contains(',')
        }
        None => true,
    };
    !line.contains('.') && line.split_whitespace().count() > 1 && line.split_whitespace().all(is_number)
}

/// Whether commas stand between digits and beside blanks in a line without a decimal point, so that either kind may separate its numbers.
fn mixes_commas(line: &str) -> bool {
    let letters: Vec<char> = line.trim_end_matches([' ', ',']).chars().collect();
    let beside = |at: usize| {
        letters[at.saturating_sub(1)].is_whitespace() || letters.get(at + 1).is_some_and(|next| next.is_whitespace())
    };
    let mut commas = (0..letters.len()).filter(|&at| letters[at] == ',').map(beside);
    let first = commas.next();
    !line.contains('.') && commas.any(|other| Some(other) != first)
}
