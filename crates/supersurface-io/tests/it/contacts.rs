//! Lists of pairs: what is wrong with one pair is told of that one, what is wrong with the file of the file.

use supersurface::contact::{WarmStart, pair};
use supersurface_io::{ContactCase, contact_line, parse_contact_cases};

const BALL: &str = r#"{"a": [1, 1, 1], "e": [1, 1], "q": [1, 0, 0, 0], "t": [0, 0, 0]}"#;

fn read(text: &str) -> Vec<ContactCase> {
    parse_contact_cases("pairs.json", text.as_bytes()).unwrap_or_else(|e| panic!("{e}"))
}

/// The pair of a ball and this body.
fn with(body: &str) -> String {
    format!(r#"{{"id": "pair", "A": {BALL}, "B": {body}}}"#)
}

/// The line of a case that cannot be queried.
fn refused(case: &ContactCase) -> String {
    let why = case.bodies.as_ref().expect_err("a broken case");
    contact_line(case, Err(why), None)
}

#[test]
fn a_pair_is_read_and_its_line_written() {
    let far = BALL.replace(r#""t": [0"#, r#""colour": 1e999, "t": [5"#);
    let cases = read(&format!("\u{feff} [{}, {}]\n", with(&far), with(BALL)));
    assert_eq!(cases.len(), 2);
    let [a, b] = cases[0].bodies.as_ref().unwrap();
    let contact = pair(a, b, &mut WarmStart::default());
    let line = contact_line(&cases[0], Ok(&contact), Some(12.5));
    assert!(line.starts_with(r#"{"id":"pair","signed_distance":3.0,"normal":[1.0,"#), "{line}");
    assert!(line.ends_with(r#","ns":12.5,"status":"ok"}"#), "{line}");
    let line = contact_line(&cases[0], Ok(&contact), None);
    assert!(!line.contains("\"ns\"") && line.contains("\"p_b\":[4.0,"), "{line}");
}

#[test]
fn what_is_wrong_with_a_pair_stays_with_it() {
    let changed = |from: &str, to: &str| with(&BALL.replace(from, to));
    let long = format!("\"{}\"", "x".repeat(100_000));
    let cases = [
        ("7".to_owned(), "is no object"),
        ("{}".to_owned(), "id: is missing"),
        (with(BALL).replace("\"pair\"", "[1]"), "id: is missing, or neither text nor a number"),
        (with(BALL).replace("\"B\"", "\"b\""), "B: is missing"),
        (with(BALL).replace("\"id\"", "\"A\": 1, \"id\""), "duplicate field `A`"),
        (with("null"), "B: is missing"),
        (with("\"ball\""), "B: invalid type: string \"ball\""),
        (changed(r#", "t": [0, 0, 0]"#, ""), "B.t: is missing"),
        (changed(r#""t": [0"#, r#""t": [NaN"#), "B.t: invalid type: string \"NaN\""),
        (changed(r#""t": [0"#, r#""t": [-Infinity"#), "string \"-Infinity\""),
        (changed(r#""t": [0"#, r#""t": [1e400"#), "B.t: number out of range"),
        (changed(r#""t": [0"#, r#""t": ["0""#), "B.t: invalid type: string \"0\""),
        (changed(r#""t": [0"#, r#""t": [null"#), "B.t: invalid type: null"),
        (changed(r#""t": [0"#, r#""t": [0, 0"#), "B.t: 4 numbers, 3 needed"),
        (changed(r#""t": [0, 0, 0]"#, r#""t": {"x": 0}"#), "B.t: invalid type: map"),
        (changed(r#""t": [0"#, &format!(r#""t": [{long}"#)), " ... "),
        (changed(r#""t": "#, r#""t": [], "t": "#), "B: duplicate field `t`"),
        (changed(r#""q": [1"#, r#""q": [0"#), "B.q: has the length 0"),
        (changed(r#""q": [1"#, r#""q": [1.1"#), "B.q: has the length 1.1"),
        (changed(r#""a": [1, 1"#, r#""a": [1, -2"#), "B: semi-axis a2 is -2"),
        (changed(r#""a": [1, 1"#, r#""a": [1, 0"#), "B: semi-axis a2 is 0"),
        (changed(r#""e": [1"#, r#""e": [2.5"#), "exponent ε1 is 2.5: it must be at most 2"),
        (changed(r#""e": [1"#, r#""e": [0"#), "exponent ε1 is 0"),
    ];
    let list: Vec<&str> = cases.iter().map(|(text, _)| text.as_str()).collect();
    let read = read(&format!("[{}]", list.join(", ")));
    assert_eq!(read.len(), cases.len());
    for (case, (text, wanted)) in read.iter().zip(&cases) {
        let line = refused(case);
        let why = case.bodies.as_ref().unwrap_err();
        assert!(why.contains(wanted), "{wanted}: {why}");
        assert!(line.contains(r#""signed_distance":null,"status":"#), "{line}");
        assert!(line.len() < 1000 && !line.contains('\n') && !why.contains(" column "), "{line}");
        let known = text.contains("\"pair\"");
        assert_eq!(line.starts_with(r#"{"id":"pair","#), known, "{line}");
    }
}

#[test]
fn ids_come_back_as_they_are() {
    for id in ["\"\"", "17", "-1e400", r#""NaN \" NaN \\""#, "\"\u{1f600}\"", "\"\\ud83d\""] {
        let line = refused(&read(&format!(r#"[{{"id": {id}, "w": NaN}}]"#))[0]);
        assert!(line.starts_with(&format!(r#"{{"id":{id},"#)), "{line}");
    }
}

#[test]
fn a_broken_file_is_named_with_the_place() {
    let fault = |bytes: &[u8]| parse_contact_cases("pairs.json", bytes).unwrap_err().to_string();
    for (text, wanted) in [
        ("", "a list of pairs is needed: [{\"id\": ..."),
        (r#"{"id": 1, "A": 2, "B": 3}"#, "a list of pairs is needed"),
        ("[1,\n 2", "line 2, column 2: EOF"),
        ("[1 2]", "line 1, column 4: expected"),
        ("[1] [2]", "line 1, column 5: trailing"),
        ("[nan]", "line 1, column"),
    ] {
        let told = fault(text.as_bytes());
        assert!(told.starts_with("pairs.json: contact cases: ") && told.contains(wanted), "{told}");
    }
    assert!(fault(b"[\"\xff\"]").contains("byte 2: is no UTF-8"));
    assert!(fault("[".repeat(1_000_000).as_bytes()).contains("EOF"));
}

#[test]
fn no_pairs_and_many_pairs_are_lists() {
    assert!(read("[]").is_empty());
    assert!(read(" [\n] ").is_empty());
    let count = 100_000;
    let many = read(&format!("[{}{}]", "{},".repeat(count), with(BALL)));
    assert_eq!(many.len(), count + 1);
    assert!(many[count].bodies.is_ok() && many[0].bodies.is_err());
}
