//! Tables that people have, and tables that cannot be used.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::fs;

use analysis::{AnovaTable, Design, anova_of_table};

fn design() -> Design {
    Design {
        subject: "who".to_owned(),
        rating: "score".to_owned(),
        within: vec!["rays".to_owned()],
        ..Design::default()
    }
}

fn analyse(name: &str, bytes: &[u8], design: &Design) -> Result<AnovaTable, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    anova_of_table(&path, design).map_err(|error| {
        assert!(error.is_input(), "{error}");
        let message = error.to_string();
        assert!(message.contains(name), "{message}");
        message
    })
}

const PLAIN: &str =
    "who,rays,score\n1,10K,2.5\n1,100K,7\n2,10K,3\n2,100K,9\n3,10K,1\n3,100K,8.25\n";

#[test]
fn a_table_reads_the_same_in_every_dress() {
    let plain = analyse("plain.csv", PLAIN.as_bytes(), &design()).unwrap();
    let dresses = [
        ("bom.csv", format!("\u{feff}{PLAIN}")),
        ("crlf.csv", PLAIN.replace('\n', "\r\n")),
        ("tabs.tsv", PLAIN.replace(',', "\t")),
        ("tabs.txt", PLAIN.replace(',', "\t")),
        ("semicolons.csv", PLAIN.replace(',', ";")),
        ("quoted.csv", PLAIN.replace("10K", "\"10K\"")),
        ("spaces.csv", PLAIN.replace(',', ", ")),
        ("more.csv", PLAIN.replace('\n', ",x\n")),
        ("no_end.csv", PLAIN.trim_end().to_owned()),
        (
            "missing.csv",
            format!("{PLAIN}3,10K,NA\n3,10K,\n3,100K,n/a\n"),
        ),
        ("exponents.csv", PLAIN.replace("2.5", "25e-1")),
    ];
    for (name, text) in dresses {
        let dressed = analyse(name, text.as_bytes(), &design()).unwrap();
        assert_eq!(dressed.effects, plain.effects, "{name}");
    }
}

#[test]
fn a_paired_comparison_is_the_square_of_t() {
    // Differences 4.5, 6, 7.25: mean 71/12, variance 91/48, so F = n mean^2 / variance = 5041 / 91 = 55.3956...
    let table = analyse("plain.csv", PLAIN.as_bytes(), &design()).unwrap();
    assert!((table.effects[0].f.unwrap() - 5041.0 / 91.0).abs() < 1e-11);
    assert_eq!((table.effects[0].df_num, table.effects[0].df_den), (1, 2));
}

#[test]
fn a_subject_without_a_rating_is_dropped_by_name() {
    let table = analyse(
        "missing.csv",
        format!("{PLAIN}4,10K,5\n4,100K,NA\n").as_bytes(),
        &design(),
    )
    .unwrap();
    assert_eq!(table.dropped_subjects, ["4"]);
    assert_eq!(table.n_subjects, 3);
}

#[test]
fn what_is_no_table_is_refused_with_its_place() {
    let cases: [(&str, &[u8], &str); 12] = [
        ("empty.csv", b"", "a column \"who\""),
        ("header.csv", b"who,rays,score\n", "no rows"),
        (
            "column.csv",
            b"id,rays,score\n1,10K,2\n",
            "found the columns id, rays, score, expected a column \"who\"",
        ),
        (
            "twice.csv",
            b"who,rays,score,score\n1,10K,2,3\n",
            "more than one column \"score\"",
        ),
        (
            "short.csv",
            b"who,rays,score\n1,10K,2\n1,20K\n",
            "line 3: found 2 fields, expected 3",
        ),
        (
            "text.csv",
            b"who,rays,score\n1,10K,good\n",
            "line 2, column score: found \"good\"",
        ),
        (
            "comma.csv",
            b"who;rays;score\n1;10K;2,5\n",
            "line 2, column score: found \"2,5\"",
        ),
        (
            "infinite.csv",
            b"who,rays,score\n1,10K,inf\n",
            "line 2, column score: found \"inf\"",
        ),
        (
            "huge.csv",
            b"who,rays,score\n1,10K,1e200\n",
            "line 2, column score",
        ),
        (
            "nameless.csv",
            b"who,rays,score\n,10K,2\n",
            "line 2, column who",
        ),
        (
            "latin1.csv",
            b"who,rays,score\n1,10K,2\nna\xefve,10K,2\n",
            "line 3: found bytes that are not UTF-8",
        ),
        (
            "level.csv",
            b"who,rays,score\n1,NA,2\n",
            "line 2, column rays",
        ),
    ];
    for (name, bytes, expected) in cases {
        let message = analyse(name, bytes, &design()).unwrap_err();
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn a_missing_file_is_the_users_to_mend() {
    let missing =
        anova_of_table(std::path::Path::new("/no/such/table.csv"), &design()).unwrap_err();
    assert!(
        missing.is_input() && missing.to_string().contains("no such file"),
        "{missing}"
    );
}

#[test]
fn a_quote_that_is_never_closed_is_named_where_it_opens() {
    // The second is in a column that is not read: it would swallow every row below it without a word.
    for (text, line) in [
        (PLAIN.replace("2,10K", "\"2,10K"), "line 4"),
        (
            format!("{}4,10K,1,\"x\n4,100K,2,y\n", PLAIN.replace('\n', ",x\n")),
            "line 8",
        ),
        (
            PLAIN
                .replace("1,10K", "\"a\nb\",10K")
                .replace("3,10K", "\"\"\"3,10K"),
            "line 7",
        ),
    ] {
        let message = analyse("open.csv", text.as_bytes(), &design()).unwrap_err();
        assert!(message.contains("never closed"), "{message}");
        assert!(message.contains(line), "{message}");
    }
    // Inside a field that does not begin with one, a quote is a letter.
    let inches = PLAIN.replace("10K", "10\"");
    assert!(analyse("inches.csv", inches.as_bytes(), &design()).is_ok());
}

#[test]
fn designs_that_contradict_themselves_are_refused() {
    let wrong = |change: fn(&mut Design)| {
        let mut design = design();
        change(&mut design);
        analyse("plain.csv", PLAIN.as_bytes(), &design).unwrap_err()
    };
    assert!(wrong(|design| design.within.clear()).contains("at least one factor"));
    assert!(
        wrong(|design| design.between = vec!["rays".to_owned()]).contains("\"rays\" in two roles")
    );
    assert!(wrong(|design| design.rating = "who".to_owned()).contains("\"who\" in two roles"));
    assert!(wrong(|design| design.observed = vec!["age".to_owned()]).contains("\"age\""));
}

#[test]
fn more_cells_than_rows_are_refused_before_memory_is() {
    let rows: String = (0..400).fold(String::from("who,a,b,c,score\n"), |text, row| {
        text + &format!("1,{row},{row},{row},5\n")
    });
    let design = Design {
        within: ["a", "b", "c"].map(str::to_owned).to_vec(),
        ..design()
    };
    let message = analyse("wide.csv", rows.as_bytes(), &design).unwrap_err();
    assert!(message.contains("400 rows"), "{message}");
}

#[test]
fn json_csv_and_text_say_the_same() {
    let table = analyse("plain.csv", PLAIN.as_bytes(), &design()).unwrap();
    let json: serde_json::Value = serde_json::from_str(&table.to_json()).unwrap();
    let keys: Vec<&String> = json["effects"][0].as_object().unwrap().keys().collect();
    let mut expected = vec![
        "effect",
        "df_num",
        "df_den",
        "ss_effect",
        "ss_error",
        "f",
        "p",
        "ln_p",
        "gg_epsilon",
        "p_gg",
        "hf_epsilon",
        "p_hf",
        "hf_epsilon_classic",
        "p_hf_classic",
        "cm_epsilon",
        "p_cm",
        "lb_epsilon",
        "p_lb",
        "pes",
        "ges",
        "omega2",
        "mauchly_w",
        "mauchly_p",
        "mauchly_p_exact",
    ];
    let csv = table.to_csv();
    assert_eq!(csv.lines().next().unwrap(), expected.join(","));
    expected.sort_unstable();
    let mut keys: Vec<&str> = keys.into_iter().map(String::as_str).collect();
    keys.sort_unstable();
    assert_eq!(keys, expected);
    let f = table.effects[0].f.unwrap();
    assert!(table.to_json().contains(&f.to_string()));
    assert!(csv.contains(&f.to_string()));
    assert!(table.to_text().contains("55.40"), "{}", table.to_text());
    assert_eq!(json["effects"][0]["mauchly_w"], serde_json::Value::Null);
}

#[test]
fn a_missing_rating_stops_the_analysis_where_the_design_says_so() {
    let table = "who,rays,score\na,1K,3\na,2K,4\nb,1K,5\nb,2K,NA\nc,1K,1\nc,2K,1\n";
    let dropped = analyse("t.csv", table.as_bytes(), &design()).unwrap();
    assert_eq!(dropped.dropped_subjects, ["b"]);
    let strict = Design {
        missing: protocols::Missing::Fail,
        ..design()
    };
    let message = analyse("t.csv", table.as_bytes(), &strict).unwrap_err();
    assert!(message.contains("ratings missing of: b"), "{message}");
}
